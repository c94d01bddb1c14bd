"""The instruction sets of this machine's processor, and which of OpenBLAS's kernels use less."""

import os
from pathlib import Path

CPUINFO = Path("/proc/cpuinfo")
# By what Linux calls the instructions that they need, the widest first. OpenBLAS names kernels after the processor that
# they were written for.
KERNELS = (
    ({"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"}, {"SkylakeX", "Cooperlake", "SapphireRapids"}),
    ({"avx2", "fma"}, {"Haswell", "Zen", "Excavator"}),
    # Every 64-bit ARM processor has NEON, and all of OpenBLAS's kernels for them use it.
    ({"asimd"}, {"armv8", "cortex", "neoverse", "thunderx", "tsv", "falkor", "emag", "a64fx", "ft2000"}),
)


def instructions(cpuinfo: str) -> set[str]:
    """Return what the first processor has, given the content of /proc/cpuinfo."""
    lines = (line.partition(":") for line in cpuinfo.splitlines())
    return next((set(words.split()) for name, _, words in lines if name.strip() in {"flags", "Features"}), set())


def fits(kernel: str) -> bool:
    """Return whether a kernel exploits this machine's processor, or is the one that the environment asks for."""
    forced = os.environ.get("OPENBLAS_CORETYPE")
    if forced:
        return kernel.lower() == forced.lower()
    return not is_below(kernel, instructions(CPUINFO.read_text()))


def is_below(kernel: str, has: set[str]) -> bool:
    """Return whether there are kernels for more of the processor's instructions than this one uses."""
    for needed, kernels in KERNELS:
        if needed <= has:
            return not any(kernel.lower().startswith(name.lower()) for name in kernels)
    return not kernel
