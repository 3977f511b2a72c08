//! certilux: batch radiosity with guaranteed occlusion and guaranteed visibility.
//!
//! The method is Leblanc and Poulin, "Guaranteed Occlusion and Visibility in Cluster Hierarchical
//! Radiosity" (2000). The modules stand in the order of the data flow: a module imports only
//! modules listed above it.
//!
//! # A solve
//!
//! ```
//! use certilux::embree::DeviceConfig;
//! use certilux::occluder::OccluderConfig;
//! use certilux::scene::{LoadConfig, SidesMode, generate::generate, load_text};
//! use certilux::solve::{PreparedScene, Silent, SolveConfig, solve};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A built-in scene; one from a disk is load_file(Path::new("room.obj"), &LoadConfig::default())?.
//! let room = generate("cornell")?;
//! let files = [("cornell.mtl", room.mtl.as_bytes())];
//! let scene = load_text("cornell", room.obj.as_bytes(), &files, &LoadConfig::default())?;
//!
//! let mut config = SolveConfig::default();
//! config.epsilon = 1e-3;
//! let prepared = PreparedScene::new(scene, SidesMode::Auto, config.seed, &DeviceConfig::default())?
//!     .with_guarantees(config.technique, &OccluderConfig::default());
//! let solved = solve(&prepared, &config, &Silent)?;
//!
//! let power = solved.power;
//! println!("{} patches; of {:.1} W emitted {:.1} W absorbed", solved.leaves, power.emitted, power.absorbed);
//! assert!(power.imbalance.abs() < 0.05);
//! # Ok(())
//! # }
//! ```
//!
//! Types that hold settings or results grow: start from their `default()` and set fields. A solve is watched, stopped
//! and saved through a [`solve::Observer`], and goes on from what was saved by [`solve::resume`].

pub mod math;

pub mod embree;

pub mod scene;

pub mod cluster;

pub mod occluder;

pub mod visibility;

pub mod solve;

pub mod reference;

pub mod experiment;

pub mod output;

pub mod job;

pub mod cli;
