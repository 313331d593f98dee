"""The paper's scenes, and the tables from which claims and open points are evaluated.

The workflow's rules import this module, so it imports no other.
"""

# In the order of theta: -5/6, 0 and 5/6.
TRAILING = "fig11"
UNIFORM = "fig10"
LEADING = "fig12"
SCENES = (TRAILING, UNIFORM, LEADING)
SLIPS = tuple(f"{scene}_slips" for scene in SCENES)
CLAIM_TABLES = (
    *SLIPS,
    *(f"{scene}_trace" for scene in SCENES),
    "noise_members",
    "noise_differences",
    "resolution_differences",
    "digits_members",
    "lyapunov",
    "model_comparison",
)
POINT_TABLES = (*SLIPS, "eq15", "measures", "reproduction")
