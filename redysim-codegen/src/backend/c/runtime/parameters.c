/* Whether the second moments of a body's mass, of which xx, yy, zz, xy, yz, xz is the inertia tensor, are not negative. */
static int redysim_is_inertia(const @number@ tensor[6])
{
    const double xx = (double)tensor[0], yy = (double)tensor[1], zz = (double)tensor[2];
    const double trace = xx + yy + zz;
    if (trace == 0.0) {
        return tensor[0] == 0 && tensor[1] == 0 && tensor[2] == 0 && tensor[3] == 0 && tensor[4] == 0 && tensor[5] == 0;
    }
    /* Scaled, so that minors do not underflow. */
    const double a = 0.5 - xx / trace, b = 0.5 - yy / trace, c = 0.5 - zz / trace;
    const double ab = -(double)tensor[3] / trace, bc = -(double)tensor[4] / trace, ac = -(double)tensor[5] / trace;
    const double determinant = a * (b * c - bc * bc) - ab * (ab * c - bc * ac) + ac * (ab * bc - b * ac);
    const double roundoff = -@roundoff@;
    return trace > 0.0 && a >= roundoff && b >= roundoff && c >= roundoff && a * b - ab * ab >= roundoff
        && b * c - bc * bc >= roundoff && a * c - ac * ac >= roundoff && determinant >= roundoff;
}
