"""The polynomials and the parts of pi/2 of f32's sine and cosine, of least relative error, with coefficients that are f32.

Remez exchange on |r| <= pi/4 and a hundredth more. Coefficients are rounded one after the other, the lowest first, and
the others are found anew for what that leaves.
"""
import struct
from mpmath import cos, lu_solve, log, matrix, mp, mpf, pi, sin

mp.prec = 200
LIMIT = (pi / 4 * mpf("1.01")) ** 2


def single(x):
    """The f32 nearest to x."""
    return mpf(struct.unpack("f", struct.pack("f", float(x)))[0])


def remez(target, weight, known, free):
    """`free` coefficients that follow `known`, and the error; of target(z) ~ sum c_i z^i, weighed."""
    first = len(known)
    rest = lambda z: target(z) - sum(c * z**i for i, c in enumerate(known))
    points = [LIMIT * (1 - mp.cos(pi * (mpf(i) + 0.5) / (free + 1))) / 2 for i in range(free + 1)]
    for _ in range(30):
        rows = [[z ** (first + i) for i in range(free)] + [(-1) ** k / weight(z)] for k, z in enumerate(points)]
        solution = lu_solve(matrix(rows), matrix([rest(z) for z in points]))
        found = [solution[i] for i in range(free)]
        error = lambda z: weight(z) * (rest(z) - sum(c * z ** (first + i) for i, c in enumerate(found)))
        grid = [LIMIT * (mpf(i) + 1) / 2000 for i in range(2000)]
        values = [error(z) for z in grid]
        extrema, last = [], None
        for z, value in zip(grid, values):
            if last is None or (value > 0) != (last[1] > 0):
                if last:
                    extrema.append(last[0])
                last = (z, value)
            elif abs(value) > abs(last[1]):
                last = (z, value)
        extrema.append(last[0])
        if len(extrema) != free + 1 or max(abs(a - b) for a, b in zip(extrema, points)) < LIMIT / 1000:
            break
        points = extrema
    return found, max(abs(value) for value in values)


def rounded(name, target, weight, count):
    known = []
    for free in range(count, 0, -1):
        found, error = remez(target, weight, known, free)
        if free == count:
            print(f"{name}: least error 2^{float(log(error, 2)):.2f}")
        known.append(single(found[0]))
    error = max(
        abs(weight(z) * (target(z) - sum(c * z**i for i, c in enumerate(known))))
        for z in (LIMIT * (mpf(i) + 1) / 2000 for i in range(2000))
    )
    print(f"    rounded 2^{float(log(error, 2)):.2f}:", ", ".join(shortest(c) for c in known))


def shortest(c):
    """The shortest decimal that is read as this f32."""
    for digits in range(6, 12):
        text = f"{float(c):.{digits}e}"
        if single(mpf(text)) == c:
            return text
    return repr(float(c))


def sine(z):
    """(sin r - r) / r^3."""
    r = mp.sqrt(z)
    return (sin(r) - r) / r**3


def cosine(z):
    """(cos r - 1 + z/2) / z^2."""
    return (cos(mp.sqrt(z)) - 1 + z / 2) / z**2


rounded("sine", sine, lambda z: z * mp.sqrt(z) / sin(mp.sqrt(z)), 3)
rounded("cosine", cosine, lambda z: z**2 / cos(mp.sqrt(z)), 3)
for bits in (16, 24):
    # All parts but the last are cut off where they must have fewer digits than an f32, and rounded where they need not.
    count, rest, parts = 3, pi / 2, []
    for index in range(count):
        scale = mpf(2) ** (mp.floor(log(abs(rest), 2)) + 1 - (bits if index + 1 < count else 24))
        part = mp.floor(rest / scale) * scale if bits < 24 and index + 1 < count else mp.nint(rest / scale) * scale
        assert single(part) == part
        parts.append(part)
        rest -= part
    print(f"pi/2 in parts of {bits} bits:", ", ".join(shortest(p) for p in parts), "rest", float(rest))
