//! Random numbers of samples. Each depends on the seed, its column and its sample alone, so that more samples leave those
//! that there were as they are.

/// What the values of a column are drawn from.
#[derive(Clone, Copy, Debug)]
pub enum Distribution {
    /// Mean and standard deviation.
    Normal(f64, f64),
    /// The least and the largest value.
    Uniform(f64, f64),
}

impl Distribution {
    /// The value of a sample in a column.
    pub fn draw(self, seed: u64, column: usize, sample: usize) -> f64 {
        let uniform = |which: u64| {
            let bits = [column as u64, sample as u64, which].iter().fold(mixed(seed), |bits, part| mixed(bits ^ part));
            // In the middle of one of 2⁵³ equal parts of (0, 1).
            ((bits >> 11) as f64 + 0.5) / (1u64 << 53) as f64
        };
        match self {
            Distribution::Uniform(least, largest) => least + (largest - least) * uniform(0),
            // Box and Muller (1958).
            Distribution::Normal(mean, deviation) => {
                let radius = (-2.0 * uniform(0).ln()).sqrt();
                mean + deviation * radius * (std::f64::consts::TAU * uniform(1)).cos()
            }
        }
    }
}

/// A step of SplitMix64 (Steele, Lea and Flood, 2014).
fn mixed(state: u64) -> u64 {
    let state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean, variance and fourth moment about `mean` of the columns 0 and 1, and their covariance.
    fn moments(distribution: Distribution, mean: f64) -> [f64; 4] {
        const COUNT: usize = 40_000;
        let draws = (0..COUNT).map(|sample| [0, 1].map(|column| distribution.draw(7, column, sample) - mean));
        let sums = draws
            .fold([0.0; 4], |[one, two, four, both], [a, b]| [one + a, two + a * a, four + a.powi(4), both + a * b]);
        sums.map(|sum| sum / COUNT as f64)
    }

    /// Of so many draws each moment deviates by its standard error; five of these are exceeded once in a million.
    #[test]
    fn draws_have_the_moments_of_their_distribution() {
        let close = |found: [f64; 4], expected: [f64; 4], errors: [f64; 4]| {
            for k in 0..4 {
                assert!((found[k] - expected[k]).abs() < 5.0 * errors[k] / 200.0, "{k}: {found:?}");
            }
        };
        // √(var x, var x², var x⁴, var xy) of the standard normal distribution, and of one on ±1.
        let normal = moments(Distribution::Normal(3.0, 1.0), 3.0);
        close(normal, [0.0, 1.0, 3.0, 0.0], [1.0, 2_f64.sqrt(), 96_f64.sqrt(), 1.0]);
        let uniform = moments(Distribution::Uniform(1.0, 3.0), 2.0);
        let third = 1.0 / 3.0_f64;
        close(
            uniform,
            [0.0, third, 0.2, 0.0],
            [third.sqrt(), (4.0_f64 / 45.0).sqrt(), (16.0_f64 / 225.0).sqrt(), third],
        );
    }

    #[test]
    fn another_seed_or_column_draws_other_numbers() {
        let draw = |seed, column, sample| Distribution::Uniform(0.0, 1.0).draw(seed, column, sample);
        let all = [draw(0, 0, 0), draw(1, 0, 0), draw(0, 1, 0), draw(0, 0, 1)];
        assert!((0..4).all(|i| (0..i).all(|j| (all[i] - all[j]).abs() > 1e-6)), "{all:?}");
    }
}
