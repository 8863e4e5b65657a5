"""The `LANES` columns of the row of a cell that waits for a stage."""

# the cell and its next flight,
SLENDERNESS, OMEGA, ETA = 0, 1, 2  # 1/a, omega, eta
PHASE, W0 = 3, 4  # phase and velocity w at the start of the flight
AT_UPLIFT = 5  # 1 if it starts with an uplift through |a f| = 1, else 0
PEAK, MODE = 6, 7  # largest z so far, its mode

# and the response so far
IMPACTS, UPLIFTS, IMPACTS_BEFORE = 8, 9, 10  # impacts, uplifts from rest, impacts before the last of them
UPLIFT_TIME, FIRST_TIME, FIRST_VELOCITY = 11, 12, 13  # times of uplift and of the first impact, its velocity
PIECE = 14  # piece of the pulse that holds the uplift at which the flight starts, or -1 if `PHASE` is set
CHATTER = 15  # whether impacts have accumulated to rest
