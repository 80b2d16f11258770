//! Decomposes a matrix of three rows and six columns, or one of six rows, with nalgebra. The program does not link if a panic
//! is left in it.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;
use nalgebra::{SMatrix, Vector6};

type Square = SMatrix<f64, 6, 6>;
type Task = SMatrix<f64, 3, 6>;

/// A number that the decomposition gives; NaN where it fails.
fn decomposed(square: Square, task: Task) -> f64 {
    let right = Vector6::repeat(1.0);
    if cfg!(feature = "cholesky") {
        return square.cholesky().map_or(f64::NAN, |found| found.solve(&right)[0]);
    }
    if cfg!(feature = "udu") {
        return square.udu().map_or(f64::NAN, |found| found.u[(0, 1)]);
    }
    if cfg!(feature = "qr") {
        return square.qr().r()[(0, 0)];
    }
    if cfg!(feature = "qr-solved") {
        return square.qr().solve(&right).map_or(f64::NAN, |found| found[0]);
    }
    if cfg!(feature = "lu") {
        return square.lu().solve(&right).map_or(f64::NAN, |found| found[0]);
    }
    if cfg!(feature = "full-piv-lu") {
        return task.full_piv_lu().u()[(2, 2)];
    }
    if cfg!(feature = "col-piv-qr") {
        return task.transpose().col_piv_qr().r()[(2, 2)];
    }
    if cfg!(feature = "col-piv-qr-basis") {
        return task.transpose().col_piv_qr().q()[(5, 2)];
    }
    if cfg!(feature = "col-piv-qr-permuted") {
        let found = task.transpose().col_piv_qr();
        let mut ordered = task.transpose();
        found.p().permute_columns(&mut ordered);
        return ordered[(5, 2)];
    }
    if cfg!(feature = "col-piv-qr-solved") {
        return square.col_piv_qr().solve(&right).map_or(f64::NAN, |found| found[0]);
    }
    if cfg!(feature = "bidiagonal") {
        return task.bidiagonalize().diagonal()[2];
    }
    if cfg!(feature = "hessenberg") {
        return square.hessenberg().unpack_h()[(0, 0)];
    }
    if cfg!(feature = "svd") {
        return task.svd(true, true).singular_values[2];
    }
    if cfg!(feature = "svd-iterated") {
        return task.try_svd_unordered(true, true, 1e-15, 100).map_or(f64::NAN, |found| found.singular_values[2]);
    }
    if cfg!(feature = "symmetric-eigen") {
        return square.symmetric_eigen().eigenvalues[0];
    }
    if cfg!(feature = "symmetric-eigen-iterated") {
        return square.try_symmetric_eigen(1e-15, 100).map_or(f64::NAN, |found| found.eigenvalues[0]);
    }
    if cfg!(feature = "pseudo-inverse") {
        return task.pseudo_inverse(1e-12).map_or(f64::NAN, |found| found[(0, 0)]);
    }
    f64::NAN
}

// The C library, which starts the program.
#[link(name = "c")]
unsafe extern "C" {}

#[unsafe(no_mangle)]
extern "C" fn main() -> i32 {
    let square = Square::from_fn(|i, j| if i == j { 3.0 } else { 0.1 * (i + j) as f64 });
    let task = Task::from_fn(|i, j| 1.0 + 0.3 * i as f64 - 0.2 * (i * j) as f64);
    i32::from(!decomposed(black_box(square), black_box(task)).is_finite())
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    unsafe extern "C" {
        fn a_panic_is_left_in_this_program() -> !;
    }
    // SAFETY: the function does not exist, so that a program that can reach this does not link.
    unsafe { a_panic_is_left_in_this_program() }
}
