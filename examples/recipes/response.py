"""Largest frequency response from the matrices of `eomgen linearise --out NAME.npz`.

    python3 response.py NAME.npz OUTPUT

Prints the static gain of OUTPUT for the first input, the largest gain of its frequency response, and their ratio. It
requires numpy.
"""

import sys

try:
    import numpy
except ImportError:
    print("response.py: numpy is missing. Install it: pip install numpy", file=sys.stderr)
    sys.exit(2)

model = numpy.load(sys.argv[1])
A, B = model["A"], model["B"][:, 0]
row = list(model["outputs"]).index(sys.argv[2])
C, D = model["C"][row], model["D"][row, 0]


def gain(frequency):
    """Returns the gain at a frequency in Hz."""
    shifted = 2j * numpy.pi * frequency * numpy.eye(len(A)) - A
    return abs(C @ numpy.linalg.solve(shifted, B) + D)


poles = abs(numpy.linalg.eigvals(A)) / (2 * numpy.pi)
frequencies = numpy.geomspace(poles.min() / 2, poles.min() * 3, 6000)
gains = [gain(frequency) for frequency in frequencies]
largest = int(numpy.argmax(gains))
unit = f"{model['output_units'][row]}/{model['input_units'][0]}"
print(f"static  {gain(0):.4e} {unit}")
print(f"largest {gains[largest]:.4e} {unit} at {frequencies[largest]:.4f} Hz")
print(f"ratio   {gains[largest] / gain(0):.3f}")
