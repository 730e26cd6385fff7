"""What a plugin's own tests are made of: `from tallgrass.testing import check_wind`."""

from .winds import check_wind, wind_problems

__all__ = ["check_wind", "wind_problems"]
