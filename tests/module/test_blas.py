"""The BLAS behind the factorization: which one it is, and that it exploits the processor."""

import ast
import os
import platform
import subprocess
import sys

import pytest
import spectral_conformal as sc

from tests.module import processor

HAS_BLAS = "CHOLMOD" in sc.build_info()["factorization"]
pytestmark = pytest.mark.skipif(not HAS_BLAS, reason="only CHOLMOD's factorization calls a BLAS")
# Without these OpenBLAS finds out by itself what the processor is.
FORCED = ("OPENBLAS_CORETYPE", "OPENBLAS_L2_SIZE")
AVX512, AVX2 = (needed for needed, _ in processor.KERNELS[:2])


def build_info(**environ):
    """Return the module's build information in a separate process with these environment variables added."""
    usual = {name: value for name, value in os.environ.items() if name not in FORCED}
    command = [sys.executable, "-c", "import spectral_conformal as sc; print(sc.build_info())"]
    result = subprocess.run(command, env={**usual, **environ}, capture_output=True, text=True, check=True)
    return ast.literal_eval(result.stdout)


def test_blas_is_openblas():
    assert "openblas" in sc.build_info()["blas"].lower()


@pytest.mark.skipif(not processor.CPUINFO.is_file(), reason="Linux tells what the processor has")
def test_kernels_are_not_below_what_the_processor_has():
    has = processor.instructions(processor.CPUINFO.read_text())
    assert not processor.is_below(build_info()["kernel"], has)


@pytest.mark.skipif(platform.machine() not in {"x86_64", "AMD64"}, reason="names kernels of x86-64")
@pytest.mark.parametrize("kernel", ["Nehalem", "Sandybridge"])
def test_kernels_that_are_told_are_those_that_run(kernel):
    assert build_info(OPENBLAS_CORETYPE=kernel)["kernel"] == kernel


@pytest.mark.parametrize(
    ("kernel", "has", "below"),
    [
        ("Prescott", AVX512 | AVX2, True),
        ("Prescott", AVX2, True),
        ("Sandybridge", AVX2, True),
        ("Haswell", AVX512 | AVX2, True),
        ("SkylakeX", AVX512 | AVX2, False),
        ("Zen", AVX2, False),
        ("Haswell", AVX2, False),
        ("Nehalem", {"sse4_2"}, False),
        ("", {"sse4_2"}, True),
        ("unknown", {"asimd"}, True),
        ("neoversen1", {"asimd"}, False),
    ],
)
def test_kernels_are_held_against_the_processor(kernel, has, below):
    assert processor.is_below(kernel, has) == below


def test_instructions_are_those_of_the_first_processor():
    text = "processor\t: 0\nflags\t\t: fpu avx2 fma\nbugs\t\t: none\n\nprocessor\t: 1\nflags\t\t: fpu\n"
    assert processor.instructions(text) == {"fpu", "avx2", "fma"}
    assert processor.instructions("Features\t: fp asimd\n") == {"fp", "asimd"}
