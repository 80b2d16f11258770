//! Calls by plain addresses, as the timer makes them.

/// A state as it lies in memory: coordinates, velocities, and accelerations or forces.
#[repr(C)]
pub struct State<Q, V> {
    pub q: Q,
    pub v: V,
    pub input: V,
}

/// Exports `function`, from a state to a result, as the C function `name`, and with its result handed over as `name_result`.
///
/// `name` leaves the result where a program in Rust has it, in a variable of its own. Where the compiler does not inline
/// the function, as those of large robots, it would compute the result elsewhere and copy it into the timer's memory: 11 kB
/// for the mass matrix of a humanoid, which no other program pays for.
macro_rules! export {
    ($name:expr, $state:ty => $result:ty, $function:expr) => {
        const _: () = {
            const FUNCTION: fn(&$state) -> $result = $function;

            #[unsafe(export_name = $name)]
            extern "C" fn call(state: &$state, _: *mut $result) -> *const $result {
                std::hint::black_box(&FUNCTION(state));
                std::ptr::null()
            }

            #[unsafe(export_name = concat!($name, "_result"))]
            extern "C" fn result<'r>(
                state: &$state,
                result: &'r mut std::mem::MaybeUninit<$result>,
            ) -> &'r mut $result {
                result.write(FUNCTION(state))
            }
        };
    };
}

pub(crate) use export;
