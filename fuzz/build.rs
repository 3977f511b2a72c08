//! Passes the rpath to a private Embree on: the engine's own build script cannot reach the
//! binaries of another package.

fn main() {
    let rpath = std::env::var("DEP_CERTILUX_EMBREE_RPATH").unwrap_or_default();
    // Empty for a system Embree.
    if !rpath.is_empty() {
        println!("cargo:rustc-link-arg=-Wl,-rpath,{rpath}");
    }
}
