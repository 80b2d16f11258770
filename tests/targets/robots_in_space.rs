//! Robots whose joints have several degrees of freedom, compiled: quaternions, of which there is one coordinate more than
//! velocities, and joints in series.

use redysim::redysim;

redysim! {
    /// KR5 on a platform that floats.
    pub struct Floating("models/kr5_floating.toml");
}

redysim! {
    /// A body that floats.
    pub struct Parcel("models/parcel.toml");
}

redysim! {
    /// A body that turns about a point.
    pub struct Pendulum("models/spherical_pendulum.toml");
}

redysim! {
    /// A planar, a universal and a cylindrical joint, and Euler angles.
    pub struct Series("models/test/joints_in_series.toml");
}
