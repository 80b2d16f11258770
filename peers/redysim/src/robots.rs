//! The robots, each from its model file.

use redysim::redysim;

redysim! {
    /// Its last link has an inertia that no body has. The paper gives it so.
    #[allow(deprecated)]
    pub struct Kr5("../../../models/peers/kr5.toml");
}
redysim! { pub struct Gripper("../../../models/peers/gripper.toml"); }
redysim! { pub struct Humanoid30("../../../models/peers/humanoid30.toml"); }
redysim! { pub struct Chain10("../../../models/peers/chain10.toml"); }
redysim! { pub struct Chain20("../../../models/peers/chain20.toml"); }
redysim! { pub struct Chain40("../../../models/peers/chain40.toml"); }
redysim! { pub struct Chain80("../../../models/peers/chain80.toml"); }
// On free bases, as `driver/imported.py` writes them.
redysim! { pub struct Anymal("../../../target/peers/robots/anymal.toml"); }
redysim! { pub struct Talos("../../../target/peers/robots/talos.toml"); }
