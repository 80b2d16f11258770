"""The f64 nearest to a multiple of pi/2 in each binade, as bits in hexadecimal.

For x = m 2^e, m of 53 bits, |x - k pi/2| is small where k/m is a good approximation of 2^e / (pi/2): a convergent of
its continued fraction, or one of the few fractions between two convergents.
"""
import struct
from fractions import Fraction
from mpmath import mp

mp.prec = 2600
PI_2 = Fraction(int(mp.pi / 2 * mp.mpf(2) ** 2500), 2**2500)


def distance(m, alpha):
    """How far m alpha is from an integer."""
    product = m * alpha
    return abs(product - round(product))


def candidates(alpha, low, high):
    """Denominators below `high` of convergents of alpha and of what lies between them; multiples up into the range."""
    a, (q0, q1), rest = [], (0, 1), alpha
    while q1 < high:
        whole = rest.numerator // rest.denominator
        if a:
            for step in {1, whole // 2, whole - 1, whole} - {0}:
                q = q0 + step * q1
                for times in (1, -(-low // q)):
                    if low <= q * times < high:
                        yield q * times
            q0, q1 = q1, q0 + whole * q1
        a.append(whole)
        rest -= whole
        if rest == 0:
            return
        rest = 1 / rest


for exponent in range(-52, 972):
    alpha = Fraction(2) ** exponent / PI_2
    found = sorted(set(candidates(alpha, 2**52, 2**53)), key=lambda m: distance(m, alpha))
    for m in found[:2]:
        if m * Fraction(2) ** exponent > 0.7:
            print(struct.pack(">d", float(Fraction(m) * Fraction(2) ** exponent)).hex())
