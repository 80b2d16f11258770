//! Operational space: the identities that define it, with random matrices of every rank.

use redysim_runtime::{FrameJacobian, OperationalSpace, OperationalSpaceError, TaskStatus};

const NV: usize = 7;
/// Products of a few well-conditioned matrices of this size.
const ROUNDOFF: f64 = 1e-12;

type Matrix<const M: usize, const N: usize> = [[f64; N]; M];

/// Numbers within ±1: a linear congruential generator (Knuth's MMIX).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn matrix<const M: usize, const N: usize>(&mut self) -> Matrix<M, N> {
        [(); M].map(|()| [(); N].map(|()| self.number()))
    }

    /// 1 + A Aᵀ.
    fn mass_matrix(&mut self) -> Matrix<NV, NV> {
        let a: Matrix<NV, NV> = self.matrix();
        sum(identity(), 1.0, times(&a, &transposed(&a)))
    }
}

fn times<const L: usize, const M: usize, const N: usize>(a: &Matrix<L, M>, b: &Matrix<M, N>) -> Matrix<L, N> {
    a.map(|row| std::array::from_fn(|j| (0..M).map(|k| row[k] * b[k][j]).sum()))
}

fn transposed<const M: usize, const N: usize>(a: &Matrix<M, N>) -> Matrix<N, M> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn identity<const N: usize>() -> Matrix<N, N> {
    std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))))
}

fn sum<const M: usize, const N: usize>(a: Matrix<M, N>, factor: f64, b: Matrix<M, N>) -> Matrix<M, N> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + factor * b[i][j]))
}

/// By Gauss-Jordan elimination with row pivoting: nothing of the runtime.
fn inverse<const N: usize>(mut a: Matrix<N, N>) -> Matrix<N, N> {
    let mut result = identity::<N>();
    for k in 0..N {
        let pivot = (k..N).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, pivot);
        result.swap(k, pivot);
        let scale = 1.0 / a[k][k];
        a[k] = a[k].map(|x| scale * x);
        result[k] = result[k].map(|x| scale * x);
        for i in (0..N).filter(|&i| i != k) {
            let factor = a[i][k];
            a[i] = std::array::from_fn(|j| a[i][j] - factor * a[k][j]);
            result[i] = std::array::from_fn(|j| result[i][j] - factor * result[k][j]);
        }
    }
    result
}

fn close<const M: usize, const N: usize>(what: &str, found: &Matrix<M, N>, expected: &Matrix<M, N>) {
    let scale = expected.iter().flatten().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (x, y) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!((x - y).abs() <= ROUNDOFF * scale, "{what}: {found:?} instead of {expected:?}");
    }
}

/// A column.
fn column<const N: usize>(x: [f64; N]) -> Matrix<N, 1> {
    x.map(|x| [x])
}

fn quadratic<const N: usize>(m: &Matrix<N, N>, x: [f64; N]) -> f64 {
    times(&[x], &times(m, &column(x)))[0][0]
}

/// A mass matrix, and a Jacobian of rank `R` at most: combinations of `R` rows, no two of which are nearly alike.
fn problem<const M: usize, const R: usize>(random: &mut Random) -> (Matrix<NV, NV>, Matrix<M, NV>) {
    let (left, right): (Matrix<M, R>, Matrix<R, NV>) = (random.matrix(), random.matrix());
    let apart = |i: usize, j: usize| if i % R == j { 2.0 } else { 0.0 };
    let left = std::array::from_fn(|i| std::array::from_fn(|j| 0.2 * left[i][j] + apart(i, j)));
    let right = std::array::from_fn(|i| std::array::from_fn(|j| 0.3 * right[i][j] + apart(j, i)));
    (random.mass_matrix(), times::<M, R, NV>(&left, &right))
}

#[test]
fn inertia_and_inverse_of_a_task_are_those_of_their_definitions() {
    let mut random = Random(1);
    for _ in 0..50 {
        let (m, j) = problem::<3, 3>(&mut random);
        let task = OperationalSpace::new(m, j).unwrap();
        assert_eq!((task.status(), task.rank()), (TaskStatus::Full, 3));
        let mobility = times(&j, &times(&inverse(m), &transposed(&j)));
        let inertia = inverse(mobility);
        close("Λ", &task.inertia(), &inertia);
        close("J̄", &task.inverse(), &times(&inverse(m), &times(&transposed(&j), &inertia)));
        close("J J̄", &times(&j, &task.inverse()), &identity());
    }
}

#[test]
fn the_projector_is_idempotent_and_its_transpose_gives_forces_that_do_not_accelerate_the_task() {
    let mut random = Random(2);
    for _ in 0..50 {
        let (m, j) = problem::<3, 3>(&mut random);
        let task = OperationalSpace::new(m, j).unwrap();
        let n = task.projector();
        close("1 − J̄ J", &n, &sum(identity(), -1.0, times(&task.inverse(), &j)));
        close("N²", &times(&n, &n), &n);
        close("J N", &times(&j, &n), &[[0.0; NV]; 3]);
        close("J M⁻¹ Nᵀ", &times(&j, &times(&inverse(m), &transposed(&n))), &[[0.0; NV]; 3]);
        // J̄ᵀ of a force that the task's own is: J̄ᵀ Jᵀ = 1.
        let f = random.matrix::<1, 3>()[0];
        close("J̄ᵀ Jᵀ f", &[task.task_force(&task.joint_force(&f))], &[f]);
    }
}

#[test]
fn kinetic_energy_splits_into_that_of_the_task_and_that_of_the_null_space() {
    let mut random = Random(3);
    for _ in 0..50 {
        let (m, j) = problem::<3, 3>(&mut random);
        let task = OperationalSpace::new(m, j).unwrap();
        let v = random.matrix::<1, NV>()[0];
        let split = quadratic(&task.inertia(), task.task_velocity(&v)) + quadratic(&m, task.null_velocity(&v));
        assert!((split - quadratic(&m, v)).abs() < ROUNDOFF * split, "{split}");
    }
}

#[test]
fn functions_of_vectors_are_the_products_with_the_matrices() {
    let mut random = Random(4);
    let (m, j) = problem::<4, 2>(&mut random);
    let task = OperationalSpace::new(m, j).unwrap();
    let (v, b) = (random.matrix::<1, NV>()[0], random.matrix::<1, 4>()[0]);
    let of = |x: [f64; NV]| column(x);
    close("N v", &of(task.null_velocity(&v)), &times(&task.projector(), &of(v)));
    close("Nᵀ τ", &of(task.null_force(&v)), &times(&transposed(&task.projector()), &of(v)));
    close("J v", &column(task.task_velocity(&v)), &times(&j, &of(v)));
    close("Jᵀ f", &of(task.joint_force(&b)), &times(&transposed(&j), &column(b)));
    close("J̄ ẋ", &of(task.joint_velocity(&b)), &times(&task.inverse(), &column(b)));
    close("J̄ᵀ τ", &column(task.task_force(&v)), &times(&transposed(&task.inverse()), &of(v)));
    close("Λ ẍ", &column(task.force_of_acceleration(&b)), &times(&task.inertia(), &column(b)));
    close("J J̄ ẋ", &column(task.attainable(&b)), &times(&times(&j, &task.inverse()), &column(b)));
}

/// Penrose's four conditions for Λ, and those of the inverse that is weighted with M.
#[test]
fn status_and_inverses_are_those_of_the_attainable_directions_at_reduced_rank() {
    let mut random = Random(5);
    for _ in 0..50 {
        let (m, j) = problem::<4, 2>(&mut random);
        let task = OperationalSpace::new(m, j).unwrap();
        let TaskStatus::Deficient { rank, rows } = task.status() else { panic!("{:?}", task.status()) };
        assert_eq!((rank, rows.iter().count()), (2, 2));
        let mobility = times(&j, &times(&inverse(m), &transposed(&j)));
        let (inertia, bar, n) = (task.inertia(), task.inverse(), task.projector());
        close("Λ", &inertia, &transposed(&inertia));
        close("A Λ A", &times(&mobility, &times(&inertia, &mobility)), &mobility);
        close("Λ A Λ", &times(&inertia, &times(&mobility, &inertia)), &inertia);
        let attained = times(&j, &bar);
        close("A Λ", &times(&mobility, &inertia), &attained);
        close("J J̄", &transposed(&attained), &attained);
        close("(J J̄)²", &times(&attained, &attained), &attained);
        close("J J̄ J", &times(&attained, &j), &j);
        close("J̄ J J̄", &times(&bar, &attained), &bar);
        close("M J̄ J", &times(&m, &times(&bar, &j)), &transposed(&times(&m, &times(&bar, &j))));
        close("N²", &times(&n, &n), &n);
        close("J N", &times(&j, &n), &[[0.0; NV]; 4]);
    }
}

#[test]
fn a_jacobian_of_zeros_leaves_everything_to_the_null_space() {
    let mass = Random(6).mass_matrix();
    let task = OperationalSpace::new(mass, [[0.0; NV]; 2]).unwrap();
    assert_eq!(task.rank(), 0);
    assert_eq!((task.inertia(), task.projector()), ([[0.0; 2]; 2], identity()));
}

#[test]
fn a_direction_is_left_at_the_tolerance_that_is_asked_for() {
    let j = |small: f64| [[1.0, 0.0], [1.0, small]];
    let status = |small, tolerance| OperationalSpace::with_tolerance(identity(), j(small), tolerance).unwrap().rank();
    assert_eq!([status(0.11, 0.05), status(0.09, 0.1)], [2, 1]);
    assert_eq!(OperationalSpace::new(identity(), j(1e-4)).unwrap().rank(), 2);
    assert_eq!(OperationalSpace::new(identity(), j(1e-6)).unwrap().rank(), 1);
}

#[test]
fn a_mass_matrix_that_is_not_positive_definite_and_a_jacobian_that_is_not_finite_are_refused() {
    let error = |m: [[f64; 2]; 2], j: [f64; 2]| OperationalSpace::new(m, [j]).err().unwrap();
    let singular = error([[1.0, 1.0], [1.0, 1.0]], [1.0, 0.0]);
    assert_eq!(singular, OperationalSpaceError::SingularInertia { velocity: 0 });
    assert!(singular.to_string().contains("velocity 0"), "{singular}");
    assert_eq!(error(identity(), [f64::NAN, 0.0]), OperationalSpaceError::NotFinite);
    assert_eq!(
        error([[1.0, 0.0], [0.0, f64::NAN]], [1.0, 0.0]),
        OperationalSpaceError::SingularInertia { velocity: 1 }
    );
}

#[test]
fn the_rows_of_a_frame_jacobian_are_linear_before_angular() {
    let jacobian = FrameJacobian { linear: [[1], [2], [3]], angular: [[4], [5], [6]] };
    assert_eq!(jacobian.rows(), [[1], [2], [3], [4], [5], [6]]);
}

#[cfg(feature = "alloc")]
#[test]
fn vectors_give_the_same_bits_as_arrays() {
    let (m, j) = problem::<3, 3>(&mut Random(7));
    let task = OperationalSpace::new(m, j).unwrap();
    let rows = |a: &[[f64; NV]]| a.iter().map(|row| row.to_vec()).collect::<Vec<_>>();
    let dynamic = OperationalSpace::new(rows(&m), rows(&j)).unwrap();
    assert_eq!(dynamic.projector(), rows(&task.projector()));
    assert_eq!(dynamic.inertia(), task.inertia().map(Vec::from).to_vec());
    assert_eq!(dynamic.inverse(), task.inverse().map(Vec::from).to_vec());
}
