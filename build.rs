//! Finds Embree 4.3 or later, compiles `ffi/` against its headers and links its library.
//!
//! Search order, first hit wins (there is no pkg-config file for Embree anywhere):
//!
//! 1. `EMBREE_DIR`: a prefix with `include/embree4/rtcore.h` and `libembree4.so` in `lib`, `lib64`
//!    or `lib/<machine>-linux-gnu`. Set but unusable is an error, never passed over.
//! 2. The system: the same below `/usr` and `/usr/local`. No rpath is needed there.
//! 3. `.embree/` beside this file: the private prefix that `setup.sh` makes where the distribution
//!    packages no Embree 4.
//!
//! Headers older than 4.3 are passed over in 2 and 3, because their layouts differ.
//!
//! Documentation tests get no rpath. They find the library through a link in `OUT_DIR`, which cargo puts on
//! the search path of what it runs.
//!
//! The library's directory is written as rpath into the package's own binaries, tests, examples
//! and benches. `cargo:rustc-link-arg` does not reach a crate that depends on this one: such a
//! crate's build script reads `DEP_CERTILUX_EMBREE_LIB_DIR` (and `DEP_CERTILUX_EMBREE_RPATH`,
//! empty for a system Embree) and passes the rpath on itself.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// Headers before this version have other layouts (4.2 lacks `RTCHit::instPrimID`).
const OLDEST_VERSION: u32 = 40_300;

struct Embree {
    include: PathBuf,
    lib: PathBuf,
    system: bool,
}

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=ffi");
    println!("cargo:rerun-if-env-changed=EMBREE_DIR");

    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let embree = match find_embree(&root) {
        Ok(embree) => embree,
        Err(message) => {
            for line in message.lines() {
                println!("cargo:warning={line}");
            }
            std::process::exit(1);
        }
    };
    println!(
        "cargo:rerun-if-changed={}",
        embree.include.join("embree4/rtcore_config.h").display()
    );

    println!("cargo:rustc-link-search=native={}", embree.lib.display());
    println!("cargo:lib_dir={}", embree.lib.display());
    println!("cargo:include={}", embree.include.display());
    if embree.system {
        println!("cargo:rpath=");
    } else {
        println!("cargo:rustc-link-arg=-Wl,-rpath,{}", embree.lib.display());
        println!("cargo:rpath={}", embree.lib.display());
    }

    name_compiler();
    link_for_doctests(&embree);
    compile_shim(&embree);
    bind_shim(&embree);
}

/// Tells the program what compiled it: instruction counts are comparable only then.
fn name_compiler() {
    let compiler = env::var_os("RUSTC").expect("set by cargo");
    let said = std::process::Command::new(compiler)
        .arg("--version")
        .output()
        .ok()
        .and_then(|output| String::from_utf8(output.stdout).ok());
    let name = said.unwrap_or_else(|| "rustc of unknown version".to_owned());
    println!("cargo:rustc-env=CERTILUX_RUSTC={}", name.trim());
}

/// Cargo searches at run time what is searched at link time below its own target folder, and nothing else.
fn link_for_doctests(embree: &Embree) {
    if embree.system || !cfg!(unix) {
        return;
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo")).join("run");
    fs::create_dir_all(&folder).expect("cargo's OUT_DIR is writable");
    let libraries = fs::read_dir(&embree.lib).into_iter().flatten().flatten();
    for library in libraries {
        let link = folder.join(library.file_name());
        // What an earlier build left may point elsewhere.
        let _ = fs::remove_file(&link);
        #[cfg(unix)]
        let _ = std::os::unix::fs::symlink(library.path(), &link);
    }
    println!("cargo:rustc-link-search=native={}", folder.display());
}

fn find_embree(root: &Path) -> Result<Embree, String> {
    if let Some(dir) = env::var_os("EMBREE_DIR") {
        let dir = PathBuf::from(dir);
        return usable(&dir, false).ok_or_else(|| {
            format!(
                "EMBREE_DIR={} holds no Embree 4.3 or later: expected include/embree4/rtcore.h and lib/libembree4.so",
                dir.display()
            )
        });
    }
    ["/usr", "/usr/local"]
        .iter()
        .find_map(|prefix| usable(Path::new(prefix), true))
        .or_else(|| usable(&root.join(".embree"), false))
        .ok_or_else(|| {
            "no Embree 4.3 or later found in EMBREE_DIR, /usr, /usr/local or .embree/\n\
             run ./setup.sh in the checkout, which brings it;\n\
             or install it (Debian 13, Ubuntu 24.04: apt-get install libembree-dev);\n\
             or set EMBREE_DIR to a prefix with include/embree4 and lib/libembree4.so"
                .to_owned()
        })
}

fn usable(prefix: &Path, system: bool) -> Option<Embree> {
    let include = prefix.join("include");
    if header_version(&include.join("embree4/rtcore_config.h"))? < OLDEST_VERSION {
        return None;
    }
    let machine = env::var("CARGO_CFG_TARGET_ARCH").expect("set by cargo");
    let lib = [
        prefix.join(format!("lib/{machine}-linux-gnu")),
        prefix.join("lib64"),
        prefix.join("lib"),
    ]
    .into_iter()
    .find(|dir| dir.join("libembree4.so").exists())?;
    Some(Embree {
        include,
        lib,
        system,
    })
}

/// `RTC_VERSION` of a `rtcore_config.h`: 40303 for 4.3.3.
fn header_version(config: &Path) -> Option<u32> {
    fs::read_to_string(config)
        .ok()?
        .lines()
        .find_map(|line| line.trim().strip_prefix("#define RTC_VERSION "))?
        .trim()
        .parse()
        .ok()
}

fn compile_shim(embree: &Embree) {
    compile_c(embree, "certilux_embree");
    if env::var_os("CARGO_FEATURE_C_BASELINE").is_some() {
        compile_c(embree, "c_baseline");
    }
}

/// Compiles `ffi/NAME.c` into a static library of its own.
fn compile_c(embree: &Embree, name: &str) {
    cc::Build::new()
        .file(format!("ffi/{name}.c"))
        .include("ffi")
        .include(&embree.include)
        .std("c11")
        // The per-ray loops are in C: never unoptimised, whatever the profile.
        .opt_level(3)
        .warnings_into_errors(true)
        .compile(name);
}

fn bind_shim(embree: &Embree) {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo")).join("shim.rs");
    bindgen::Builder::default()
        .header("ffi/certilux_embree.h")
        .clang_arg(format!("-I{}", embree.include.display()))
        .clang_arg("-std=c11")
        .allowlist_item("certilux_.*")
        .allowlist_item("CERTILUX_.*")
        // Handles are embree4-sys's types; layouts come as constants.
        .blocklist_type("RTC.*")
        .prepend_enum_name(false)
        .generate()
        .expect("libclang can read ffi/certilux_embree.h; ./setup.sh installs libclang-dev")
        .write_to_file(out)
        .expect("cargo's OUT_DIR is writable");
}
