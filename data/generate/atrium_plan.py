"""The dimensions of atrium.glb, in metres.

A side's frame, in which its parts are modelled: x along the arcade; z = 0 is the line of column axes, +z the court, -z
the back wall; y = 0 is the arcade's floor. A bay is centred on x = 0.
"""

BAY = 3.2  # between column axes, and from them to the back wall
COURT_LEVEL = -0.15  # the court lies a step below the arcade
STEP = 0.45  # how far the arcade's floor reaches into the court
SPRINGING, ARCH_RADIUS = 3.0, 1.3
HALF_WALL = 0.25  # half the thickness of the lower arcade wall
RIB = 0.2  # half the width of a transverse rib
PILASTER = 0.14  # its projection from the back wall
VAULT_RISE = 1.45
UPPER_FLOOR = 4.9
UPPER_SPRINGING, UPPER_RADIUS, UPPER_HALF_WALL = 7.2, 0.62, 0.18
CEILING = 8.15
RAIL = UPPER_FLOOR + 0.9  # top of the balustrade
EAVES_OUT, EAVES_LEVEL = 0.75, 8.42
OUTER = BAY + 0.5  # outside of the outer wall
ROOF_PITCH = 0.325
DADO = 1.05  # height of the painted foot of the back walls
WINDOW_RADIUS, WINDOW_SPRINGING = 0.62, 2.25
