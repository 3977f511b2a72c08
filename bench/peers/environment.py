"""A scratch environment with the peers in it: nothing outside the scratch folder is changed."""

import ctypes.util
import os
import subprocess
import sys
from pathlib import Path

# The versions that the committed run was made with.
PACKAGES = ["mitsuba==3.9.1", "pyradiance==1.3.1", "numpy"]
# LLVM that Mitsuba is known to work with: the 14 and 15 of Debian 12 abort in it.
LLVM_PACKAGE = "libllvm19"
LLVM_NAMES = ["libLLVM.so.19.1", "libLLVM-19.so.1", "libLLVM-19.so", "libLLVM.so.20.1"]


def python_of(scratch: Path) -> Path:
    """The interpreter of the scratch environment, made and filled where it is not there."""
    python = scratch / "venv" / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(scratch / "venv")], check=True)
    stamp = scratch / "venv" / "packages.txt"
    wanted = "\n".join(PACKAGES)
    if not stamp.exists() or stamp.read_text() != wanted:
        subprocess.run([str(python), "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
        stamp.write_text(wanted)
    return python


def find_llvm(scratch: Path) -> Path | None:
    """An LLVM for Mitsuba: the one named by DRJIT_LIBLLVM_PATH, one of the system, or one unpacked from the
    distribution's package into the scratch folder."""
    named = os.environ.get("DRJIT_LIBLLVM_PATH")
    if named:
        return Path(named)
    folders = [Path("/usr/lib/x86_64-linux-gnu"), Path("/usr/lib/aarch64-linux-gnu")]
    system = [folder / name for folder in folders for name in LLVM_NAMES]
    unpacked = scratch / "llvm"
    for attempt in range(2):
        found = [path for path in system if path.exists()]
        found += [path for name in LLVM_NAMES for path in unpacked.glob(f"usr/lib/*/{name}")]
        if found:
            return found[0]
        if attempt == 0:
            unpack_llvm(unpacked)
    found = ctypes.util.find_library("LLVM")
    return Path(found) if found else None


def unpack_llvm(folder: Path) -> None:
    """Downloads the package with the system's own client and unpacks it; installs nothing."""
    folder.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(["apt-get", "download", LLVM_PACKAGE], cwd=folder, capture_output=True)
    for package in folder.glob("*.deb") if done.returncode == 0 else []:
        subprocess.run(["dpkg-deb", "-x", str(package), str(folder)], check=True)
