"""Numbers of 50 digits, and vectors and matrices of them."""

from collections.abc import Callable, Sequence
from decimal import Decimal, getcontext, localcontext

DIGITS = 50
getcontext().prec = DIGITS

Vector = tuple[Decimal, Decimal, Decimal]
# Rows.
Matrix = tuple[Vector, Vector, Vector]

ZERO: Vector = (Decimal(0), Decimal(0), Decimal(0))
IDENTITY: Matrix = tuple(tuple(Decimal(row == column) for column in range(3)) for row in range(3))


def added(*vectors: Vector) -> Vector:
    return tuple(map(sum, zip(*vectors)))


def scaled(factor: Decimal, vector: Vector) -> Vector:
    return tuple(factor * entry for entry in vector)


def dot(one: Sequence[Decimal], other: Sequence[Decimal]) -> Decimal:
    return sum(map(Decimal.__mul__, one, other), Decimal(0))


def cross(one: Vector, other: Vector) -> Vector:
    (a, b, c), (x, y, z) = one, other
    return (b * z - c * y, c * x - a * z, a * y - b * x)


def applied(matrix: Matrix, vector: Vector) -> Vector:
    return tuple(dot(row, vector) for row in matrix)


def product(one: Matrix, other: Matrix) -> Matrix:
    columns = transposed(other)
    return tuple(tuple(dot(row, column) for column in columns) for row in one)


def transposed(matrix: Matrix) -> Matrix:
    return tuple(zip(*matrix))


def normalised(vector: Sequence[Decimal]) -> tuple[Decimal, ...]:
    length = dot(vector, vector).sqrt()
    return tuple(entry / length for entry in vector)


def turned_about(axis: Vector, angle: Decimal) -> Matrix:
    """The rotation about a unit vector: 1 + sin φ ã + (1 − cos φ) ã²."""
    x, y, z = axis
    skew = ((Decimal(0), -z, y), (z, Decimal(0), -x), (-y, x, Decimal(0)))
    sine, cosine = sine_cosine(angle)
    terms = zip(IDENTITY, skew, product(skew, skew))
    return tuple(added(one, scaled(sine, a), scaled(1 - cosine, b)) for one, a, b in terms)


def of_rpy(rpy: Vector) -> Matrix:
    """A URDF's angles: about the fixed x, then y, then z."""
    x, y, z = (turned_about(axis, angle) for axis, angle in zip(IDENTITY, rpy))
    return product(z, product(y, x))


def of_quaternion(quaternion: Sequence[Decimal]) -> Matrix:
    """x, y, z, w, of any length but zero."""
    x, y, z, w = normalised(quaternion)
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def sine_cosine(angle: Decimal) -> tuple[Decimal, Decimal]:
    """By their series. The largest term is below e^|angle|, so that this many more digits are carried."""
    with localcontext() as context:
        context.prec = DIGITS + 5 + int(abs(angle))
        smallest = Decimal(10) ** -context.prec
        sums, term, order = [Decimal(1), Decimal(0)], Decimal(1), 0
        while abs(term) > smallest or order < abs(angle):
            order += 1
            term = term * angle / order
            sums[order % 2] += -term if order % 4 in (2, 3) else term
    cosine, sine = sums
    return +sine, +cosine


def solution(matrix: Sequence[Sequence[Decimal]], right: Sequence[Decimal]) -> list[Decimal]:
    """x of A x = b, by elimination with the largest pivot of each column."""
    rows = [[*row, entry] for row, entry in zip(matrix, right, strict=True)]
    size = len(rows)
    for at in range(size):
        largest = max(range(at, size), key=lambda row: abs(rows[row][at]))
        rows[at], rows[largest] = rows[largest], rows[at]
        for row in range(at + 1, size):
            factor = rows[row][at] / rows[at][at]
            if factor != 0:
                rows[row] = [entry - factor * above for entry, above in zip(rows[row], rows[at])]
    found: list[Decimal] = []
    for row in reversed(rows):
        known = row[size - len(found) : size]
        found.insert(0, (row[size] - dot(known, found)) / row[size - len(found) - 1])
    return found


def numbers(text: str, number: Callable[[str], Decimal]) -> tuple[Decimal, ...]:
    return tuple(number(word) for word in text.split())


def double(text: str | float) -> Decimal:
    """What a program of doubles takes this for, exactly."""
    return Decimal(float(text))
