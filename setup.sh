#!/bin/sh
# Brings what the build needs and the machine lacks: Intel Embree 4.3 or later with its headers,
# libclang (for bindgen) and a C++ compiler. Says what it does; does nothing the second time.
#
#   ./setup.sh            what building, testing and the demo need
#   ./setup.sh --check    the same, and the tools of `make check` (rustfmt, clippy, cargo-deny, cargo-fuzz)
#
# Embree is taken from, in this order (build.rs searches in the same order):
#   1. $EMBREE_DIR, if set: a prefix with include/embree4 and lib; never changed here;
#   2. the system: Debian 13, Ubuntu 24.04 and later package Embree 4 (libembree-dev);
#   3. .embree/ in this checkout, a private prefix, where the distribution has none (Debian 12):
#      the library from a PyPI wheel that carries it, the headers from Debian 13's libembree-dev.
# Packages are installed by apt where that is allowed (root, or sudo without a password); elsewhere
# the command to run is printed. Nothing from another release of Debian is ever installed.
set -eu
cd "$(dirname "$0")"

# The wheel and its digest: the library is 4.4.0, built for every x86-64 Linux with glibc 2.28.
WHEEL=embreex==4.4.0.post1
WHEEL_PLATFORM=manylinux_2_28_x86_64
WHEEL_SHA256=2cd0f7d5c6342e6247e31f700761689cae7829454d8c6de0c41e62124a023e1f
# The release whose headers the private prefix takes: Embree 4.3.3, whose layouts 4.4.0 keeps.
HEADERS_SUITE=trixie
# Pinned, so that a new lint of the tool cannot fail an old commit.
CARGO_DENY=0.20.2
CARGO_FUZZ=0.13.2

say() { printf 'setup: %s\n' "$*"; }
fail() { printf 'setup: %s\n' "$*" >&2; exit 1; }
has() { command -v "$1" >/dev/null 2>&1; }

# --- apt ---------------------------------------------------------------------------------------

if ! has apt-get; then
    AS_ROOT=none
elif [ "$(id -u)" = 0 ]; then
    AS_ROOT=
elif has sudo && sudo -n true 2>/dev/null; then
    AS_ROOT='sudo -n'
else
    AS_ROOT=none
fi

LISTS_FRESH=no
refresh_lists() {
    [ "$LISTS_FRESH" = no ] && [ "$AS_ROOT" != none ] || return 0
    say "refreshing apt's package lists"
    $AS_ROOT apt-get update -qq || fail "apt-get update failed; see its message above"
    LISTS_FRESH=yes
}

install_packages() {
    [ $# -gt 0 ] || return 0
    if [ "$AS_ROOT" = none ]; then
        say "these Debian packages are missing, and this user may not install them:" >&2
        fail "    run as root: apt-get update && apt-get install --no-install-recommends $*"
    fi
    refresh_lists
    say "installing $*"
    # dpkg must not ask questions: set-up runs unattended.
    $AS_ROOT env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "$@" </dev/null \
        || fail "apt-get install $* failed; see its message above"
}

# --- compilers and libclang ----------------------------------------------------------------------

# Prints the libclang libraries found. libclang-cpp, the C++ library that every clang brings along, is another
# library and does not serve bindgen.
find_libclang() {
    for dir in ${LIBCLANG_PATH:-/usr/lib/llvm-*/lib /usr/lib/*-linux-gnu /usr/lib64 /usr/local/lib}; do
        for library in "$dir"/libclang.so* "$dir"/libclang-*.so* "$dir"; do
            case "$library" in
                */libclang-cpp*) ;;
                *libclang*.so*) [ ! -e "$library" ] || echo "$library" ;;
            esac
        done
    done
}

setup_compilers() {
    missing=
    has cc || missing="$missing gcc libc6-dev"
    # libFuzzer, which the fuzz targets link, is C++.
    has c++ || missing="$missing g++"
    [ -n "$(find_libclang)" ] || missing="$missing libclang-dev"
    # shellcheck disable=SC2086  # a list of words
    install_packages $missing
}

# --- Embree --------------------------------------------------------------------------------------

# header_version FILE: the version as a number, 40303 for 4.3.3; 0 where there is none.
header_version() {
    [ -f "$1" ] || { echo 0; return; }
    awk '$1 == "#define" && $2 == "RTC_VERSION" { n = $3 } END { print n + 0 }' "$1"
}

# usable PREFIX LIBDIR...: true when the prefix holds headers of 4.3 or later and the library.
usable() {
    prefix=$1
    shift
    [ "$(header_version "$prefix/include/embree4/rtcore_config.h")" -ge 40300 ] || return 1
    for dir in "$@"; do
        [ ! -e "$dir/libembree4.so" ] || return 0
    done
    return 1
}

system_embree() {
    usable /usr /usr/lib/*-linux-gnu /usr/lib64 /usr/lib \
        || usable /usr/local /usr/local/lib /usr/local/lib64
}

packaged_embree() {
    has apt-cache || return 1
    candidate=$(LC_ALL=C apt-cache policy libembree-dev 2>/dev/null | awk '/Candidate:/ { print $2 }')
    # Bare images come without package lists.
    if [ -z "$candidate" ] || [ "$candidate" = '(none)' ]; then
        refresh_lists
        candidate=$(LC_ALL=C apt-cache policy libembree-dev 2>/dev/null | awk '/Candidate:/ { print $2 }')
    fi
    case "$candidate" in
        4.[0-2].* | [0-3].* | '' | '(none)') return 1 ;;
    esac
}

# The machine's main Debian entry, with the release's name replaced, in FILE.list or FILE.sources:
# whatever mirror the machine uses is used here too.
copy_debian_entry() {
    out=$1
    codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
    for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
        [ -f "$list" ] || continue
        line=$(grep -E "^deb +(\[[^]]*\] +)?[^ ]+ +$codename +(.* )?main( |\$)" "$list" | head -n 1)
        [ -n "$line" ] || continue
        printf '%s\n' "$line" | sed -E "s/ $codename .*/ $HEADERS_SUITE main/" >"$out.list"
        echo "$out.list"
        return 0
    done
    for list in /etc/apt/sources.list.d/*.sources; do
        [ -f "$list" ] || continue
        grep -v '^#' "$list" | awk -v RS= -v have="$codename" -v want="$HEADERS_SUITE" '
            done { next }
            $0 ~ "(^|\n)Suites:([^\n]*[ \t])?" have "([ \t\n]|$)" {
                gsub(/(^|\n)Types:[^\n]*/, "\nTypes: deb")
                gsub(/\nSuites:[^\n]*/, "\nSuites: " want)
                gsub(/\nComponents:[^\n]*/, "\nComponents: main")
                sub(/^\n/, "")
                print
                done = 1
            }' >"$out.sources"
        [ -s "$out.sources" ] || continue
        echo "$out.sources"
        return 0
    done
    return 1
}

# download_headers WORK: unpacks Debian 13's libembree-dev below WORK/headers, by an apt
# configuration of its own that leaves the machine's lists and packages alone.
download_headers() {
    apt_root=$1/apt
    mkdir -p "$apt_root/lists/partial" "$apt_root/cache/archives/partial" "$1/headers"
    entry=$(copy_debian_entry "$apt_root/main") \
        || fail "no entry of this Debian's main archive in /etc/apt; set EMBREE_DIR to an Embree 4.3 or later"
    cat >"$apt_root/apt.conf" <<CONF
Dir::Etc::sourcelist "$entry";
Dir::Etc::sourceparts "-";
Dir::State::lists "$apt_root/lists";
Dir::Cache "$apt_root/cache";
Acquire::Languages "none";
APT::Architectures { "amd64"; };
CONF
    # apt's download user cannot enter a checkout in a private home.
    [ "$(id -u)" != 0 ] || echo 'APT::Sandbox::User "root";' >>"$apt_root/apt.conf"
    APT_CONFIG=$apt_root/apt.conf apt-get update -qq \
        || fail "could not read the package list of Debian's $HEADERS_SUITE"
    (cd "$apt_root" && APT_CONFIG=$apt_root/apt.conf apt-get download -qq libembree-dev) \
        || fail "could not download libembree-dev of Debian's $HEADERS_SUITE"
    dpkg-deb -x "$apt_root"/libembree-dev_*.deb "$1/headers"
}

# download_library WORK: unpacks the wheel below WORK/wheel.
download_library() {
    missing=
    [ -e /etc/ssl/certs/ca-certificates.crt ] || missing="$missing ca-certificates"
    python3 -m pip --version >/dev/null 2>&1 || missing="$missing python3-pip"
    # shellcheck disable=SC2086  # a list of words
    install_packages $missing
    python3 -m pip download --quiet --disable-pip-version-check --only-binary=:all: --no-deps \
        --python-version 311 --platform "$WHEEL_PLATFORM" --dest "$1" "$WHEEL" \
        || fail "pip could not download $WHEEL"
    wheel=$(ls "$1"/embreex-*.whl)
    echo "$WHEEL_SHA256  $wheel" | sha256sum --check --quiet \
        || fail "$wheel is not the file expected (sha256 $WHEEL_SHA256); nothing was installed"
    python3 -m zipfile -e "$wheel" "$1/wheel"
}

private_embree() {
    [ "$(uname -s)-$(uname -m)" = Linux-x86_64 ] && has apt-get && has dpkg-deb \
        || fail "no Embree 4.3 or later found, and the private prefix is made on x86-64 Debian only; install Embree 4.3 or later, or set EMBREE_DIR to it"
    say "this system packages no Embree 4.3 or later: making a private one in .embree/"
    work=$(mktemp -d)
    trap 'rm -rf "$work" .embree.partial' EXIT
    trap 'exit 130' INT TERM
    say "downloading the library (PyPI wheel $WHEEL)"
    download_library "$work"
    say "downloading the headers (libembree-dev of Debian's $HEADERS_SUITE; nothing is installed from it)"
    download_headers "$work"

    rm -rf .embree.partial
    mkdir -p .embree.partial/include .embree.partial/lib
    cp -r "$work/headers/usr/include/embree4" .embree.partial/include/
    find "$work/wheel" \( -name 'libembree4*.so*' -o -name 'libtbb*.so*' \) \
        -exec cp {} .embree.partial/lib/ \;
    (cd .embree.partial/lib && ln -s libembree4*.so.4 libembree4.so)
    echo "$WHEEL_SHA256" >.embree.partial/wheel.sha256
    usable .embree.partial .embree.partial/lib || fail "the downloads hold no Embree 4.3 or later"
    # Put in place in one step: an interrupted set-up leaves nothing half made.
    rm -rf .embree
    mv .embree.partial .embree
}

setup_embree() {
    if [ -n "${EMBREE_DIR:-}" ]; then
        usable "$EMBREE_DIR" "$EMBREE_DIR/lib" "$EMBREE_DIR/lib64" "$EMBREE_DIR"/lib/*-linux-gnu \
            || fail "EMBREE_DIR=$EMBREE_DIR holds no Embree 4.3 or later (include/embree4 and lib/libembree4.so)"
        say "Embree: $EMBREE_DIR (EMBREE_DIR)"
        return
    fi
    if system_embree; then
        say "Embree: the system's"
        return
    fi
    if usable .embree .embree/lib && [ "$(cat .embree/wheel.sha256 2>/dev/null)" = "$WHEEL_SHA256" ]; then
        say "Embree: .embree/ (private prefix)"
        return
    fi
    if packaged_embree; then
        install_packages libembree-dev
        system_embree || fail "libembree-dev is installed but holds no Embree 4.3 or later"
        say "Embree: the system's"
    else
        private_embree
        say "Embree: .embree/ (private prefix)"
    fi
}

# --- tools of `make check` -----------------------------------------------------------------------

setup_check_tools() {
    for tool in rustfmt clippy; do
        cargo "$([ "$tool" = rustfmt ] && echo fmt || echo clippy)" --version >/dev/null 2>&1 && continue
        has rustup || fail "the toolchain lacks $tool; install it (Debian: apt-get install rustfmt rust-clippy)"
        say "adding $tool to the toolchain"
        rustup component add "$tool"
    done
    install_tool deny "$CARGO_DENY"
    install_tool fuzz "$CARGO_FUZZ"
}

# install_tool NAME VERSION: builds cargo-NAME unless that version is there.
install_tool() {
    [ "$(cargo "$1" --version 2>/dev/null)" != "cargo-$1 $2" ] || return 0
    say "building cargo-$1 $2 (a few minutes, once)"
    # It runs for seconds: optimising it would take longer than it ever saves.
    CARGO_PROFILE_RELEASE_OPT_LEVEL=0 CARGO_PROFILE_RELEASE_LTO=off \
        cargo install --quiet --locked "cargo-$1" --version "$2"
}

case "${1:-}" in
    '' | --check) ;;
    *) fail "usage: ./setup.sh [--check]" ;;
esac
has cargo || fail "no cargo: install a Rust toolchain of 1.88 or later first"
setup_compilers
setup_embree
[ "${1:-}" != --check ] || setup_check_tools
say "done"
