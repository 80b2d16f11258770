//! Calls by plain addresses, as the timer makes them.

/// A state as it lies in memory: coordinates, velocities, and accelerations or forces.
#[repr(C)]
pub struct State<V> {
    pub q: V,
    pub v: V,
    pub input: V,
}

/// Exports `function`, from a state to a result, as the C function `name`.
///
/// The state is read and the result written where they are; nothing is copied around the function itself.
macro_rules! export {
    ($name:expr, $state:ty => $result:ty, $function:expr) => {
        const _: () = {
            #[unsafe(export_name = $name)]
            extern "C" fn call(state: *const $state, result: *mut $result) -> *const $result {
                let function: fn(&$state) -> $result = $function;
                // SAFETY: the timer hands over the address of a state, and that of memory for a result, of these types.
                unsafe {
                    result.write(function(&*state));
                }
                result
            }
        };
    };
}

pub(crate) use export;
