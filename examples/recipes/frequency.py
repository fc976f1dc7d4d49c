"""Frequency of an oscillation about 0 in a trajectory of `eomgen simulate`.

    python3 frequency.py FILE.csv NAME

Prints the frequency and the amplitude of the first and of the last complete cycle of the column NAME.
"""

import csv
import sys

with open(sys.argv[1], newline="") as file:
    rows = [(float(row["t"]), float(row[sys.argv[2]])) for row in csv.DictReader(file)]

crossings = []  # rows and times at which the column changes from negative to positive
for k in range(1, len(rows)):
    (t_0, x_0), (t_1, x_1) = rows[k - 1], rows[k]
    if x_0 < 0 <= x_1:
        crossings.append((k, t_0 + (t_1 - t_0) * x_0 / (x_0 - x_1)))

for name, n in [("first", 0), ("last", len(crossings) - 2)]:
    (begin, t_0), (end, t_1) = crossings[n], crossings[n + 1]
    cycle = [x for _, x in rows[begin:end]]
    print(f"{name:5} cycle: {1 / (t_1 - t_0):.1f} Hz, amplitude {(max(cycle) - min(cycle)) / 2:.4e}")
