"""Boundaries of the regions of outcome: thresholds on a line of the control space, and curves through it.

The plane of 1/a and log omega is divided into regions of one outcome each, some a millionth wide. Curves are found from
lines omega = const, in five steps:

1. The solver classifies nodes on each line, and every change of outcome between two of them is refined until the last
   point on one side and the first one on the other are 1e-12 apart (`search`). The line has become a column: regions
   from bottom to top, and the thresholds between them (`columns`).
2. The thresholds of two neighbouring columns are matched in order, by the regions on their two sides and by where the
   slopes of their curves lead, at least cost (`matching`). Matched thresholds lie on one curve.
3. A region that only one of the two columns has is looked for in the other one, where its slopes lead; what is found
   there is looked for in the next column. So a thin region that any node shows is followed to its end (`tracer`).
4. What still differs between two columns, between two matched thresholds, is a panel: in it regions end, divide or
   begin. A further column divides it, halfway or near the predicted end of its region, until that place is known to
   1e-4 in log omega. Then the shortest joins close the outlines (`panels`).
5. Joins are put in order to chains, one for each outline (`chains`), and chords are halved until their middle is as
   near to the curve as `CHORD` (`chords`). `tracing` calls all this and makes the data set.

For example, overturning after two impacts under the cosine is a tongue 1e-4 wide at omega = 1.2: one node on one line
shows it, its two thresholds have no partner in the next column (2), eleven points around the predicted place find it
there (3), and so on from column to column; where it becomes narrower than `THINNEST` its two curves are joined (4).

`amplitude` and `frequency` do the first step alone, on one line; `curves` and `cells` read finished data sets.
"""
