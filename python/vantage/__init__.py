"""Vantage: where should a depth sensor look next?

Poses and views are 4x4 arrays (world from sensor, metres; sensor axes x right, y down, z forward), resolutions are pairs
(columns, rows), angles are radians except in the options by keyword, which are those of the command line. What goes wrong
raises vantage.Error; misuse and bad input raise vantage.InputError, which is a ValueError too.
"""

try:
    import numpy as _numpy  # noqa: F401  the module hands arrays over
except ImportError as error:
    raise ImportError("vantage needs numpy: install Debian's python3-numpy, or run `pip install numpy`") from error

from ._vantage import *  # noqa: F403
from ._vantage import __version__  # noqa: F401
