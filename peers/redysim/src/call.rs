//! Calls by plain addresses, as the timer makes them.

/// A state as it lies in memory: coordinates, velocities, and accelerations or forces.
#[repr(C)]
pub struct State<Q, V> {
    pub q: Q,
    pub v: V,
    pub input: V,
}

/// Exports `function`, from a state to a result, as the C function `name`.
///
/// The arguments are references, which tell the compiler that state and result lie apart: then it writes the result
/// where the timer wants it. Otherwise it would copy it there, in wider pieces than it was written in, which waits for
/// memory.
macro_rules! export {
    ($name:expr, $state:ty => $result:ty, $function:expr) => {
        const _: () = {
            #[unsafe(export_name = $name)]
            extern "C" fn call<'r>(state: &$state, result: &'r mut std::mem::MaybeUninit<$result>) -> &'r mut $result {
                let function: fn(&$state) -> $result = $function;
                result.write(function(state))
            }
        };
    };
}

pub(crate) use export;
