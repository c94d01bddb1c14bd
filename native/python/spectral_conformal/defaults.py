"""What both commands and the Blender add-on start with, so that the same mesh gets the same map everywhere.

`Options()` alone is the paper's map: `parameterize` and `unwrap` return the eigenvector of Eq. 5 unless asked for more.
For what artists get, `sc.unwrap(mesh, options=sc.defaults.MAPS)`.
"""

from dataclasses import replace
from typing import Literal

from ._options import Options, SeamOptions

MAPS = Options(hole_rigidity="automatic", polish="angles")
"""Of maps. Polish lowers the mean distortion by a few steps that reuse the factor; "balanced" would take a tenth to a
fifth of the whole time more. Holes keep their shape where that lowers the distortion."""
SEAMS = SeamOptions()
"""Of seams, also those of `suggest_seams`. A `scale_limit` of 1.25 has sizes within a quarter of the median, as
artists' seams have them; at a `qc_limit` of 1.1 angles are off by up to 5 degrees on average."""
UNATTENDED_SEAMS = replace(SEAMS, qc_limit=1.01, qc_gain=0.001)
"""Of seams in files. Nobody inspects each asset and asks for more cuts, so a mesh gets all cuts that pay until its
angle distortion is invisible. Of 23 kinds of generated meshes, 12 had more distortion than with xatlas at the limit of
`SEAMS`, 3 at this one and 3 without a limit, which cuts a good rock into 34 islands instead of 6
(tests/benchmarks/generated_assets.py)."""
MARGIN = 4.0
"""Between islands, in pixels: one pixel is left at the second level of a mipmap."""
TEXTURE_SIZE = 1024
"""Side of the texture in pixels, where nothing says which it is."""
ROTATION: Literal["square"] = "square"
"""Of packed islands: straight ones stay along the rows of the texture, others turn to fill it."""
