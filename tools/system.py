"""The system libraries that glrt needs: finds what is lacking and installs it with apt."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from typing import NamedTuple

import probes
import steps


class Need(NamedTuple):
    """Something outside Python: how to try it, and what brings it."""

    name: str
    probe: Callable[[], str]
    packages: tuple[str, ...]  # of Debian
    elsewhere: str  # what to look for on other systems


CXX = Need("the C++ runtime", probes.cxx, ("libstdc++6",), "libstdc++")
VENV = Need(
    "Python environments",
    probes.venv,
    (f"python{sys.version_info[0]}.{sys.version_info[1]}-venv",),
    "Python's modules venv and ensurepip",
)
EGL = Need(
    "OpenGL through EGL",
    probes.egl,
    ("libgl1", "libegl1", "libegl-mesa0", "libgl1-mesa-dri"),
    "Mesa's EGL library and OpenGL drivers (Fedora: mesa-libEGL mesa-libGL mesa-dri-drivers; "
    "Arch: mesa; Alpine: mesa-egl mesa-gl mesa-dri-gallium) or the driver of your graphics card",
)
OSMESA = Need(
    "OpenGL through OSMesa", probes.osmesa, ("libosmesa6",), "OSMesa, where Mesa still brings it"
)
XVFB = Need(
    "Xvfb for hidden windows",
    probes.xvfb,
    ("xvfb", "libx11-6"),
    "Xvfb (Fedora: xorg-x11-server-Xvfb; Arch: xorg-server-xvfb; Alpine: xvfb)",
)
VULKAN = Need(
    "Vulkan, for the WGSL version that the tests compare with",
    probes.vulkan,
    ("libvulkan1", "mesa-vulkan-drivers"),
    "Vulkan (Fedora: vulkan-loader mesa-vulkan-drivers; Arch: vulkan-icd-loader vulkan-swrast; "
    "Alpine: vulkan-loader mesa-vulkan-swrast) or the driver of your graphics card",
)

WINDOW = Need(
    "a window",
    probes.window,
    ("libgl1", "libx11-6", "libxext6", "libxcursor1", "libxi6", "libxinerama1", "libxrandr2"),
    "OpenGL for X11 (Fedora: mesa-libGL libX11 libXext; Arch: mesa libx11 libxext; "
    "Alpine: mesa-gl libx11 libxext)",
)
LLVM = Need(
    "LLVM 19 and libatomic for Mitsuba, the renderer that benchmarks and CI compare with",
    probes.llvm,
    ("libllvm19", "libatomic1"),
    "LLVM 19 and libatomic (Fedora: llvm-libs libatomic; Arch: llvm-libs gcc-libs; "
    "Alpine: llvm19-libs libatomic)",
)
GLSLANG = Need(
    "glslang, which holds the shaders against the GLSL standard",
    probes.glslang,
    ("glslang-tools",),
    "glslang (Fedora, Arch, Alpine: glslang)",
)

CHROMIUM = Need(
    "a headless Chromium, in which pages are tested",
    probes.chromium,
    ("chromium-headless-shell",),
    "Chromium (Fedora: chromium-headless; Arch, Alpine: chromium)",
)

WANTED = {
    "bench": (CXX, VENV, EGL, OSMESA, XVFB, WINDOW, VULKAN, GLSLANG, LLVM, CHROMIUM),
    "check": (CXX, VENV),
    "render": (CXX, VENV, EGL, OSMESA),
    "test": (CXX, VENV, EGL, OSMESA, XVFB, WINDOW, VULKAN, GLSLANG),
    "view": (CXX, VENV, EGL, OSMESA, WINDOW),
}
Missing = Mapping[Need, str]  # what does not work, and why


def provide(purpose: str, strict: bool) -> list[str]:
    """Install what the purpose lacks; returns the names of what it then still has to do without.

    Ends the program if something required lacks. `strict` requires all that is wanted.
    """
    if not sys.platform.startswith("linux"):
        return _provide_elsewhere()
    missing = find_missing(purpose)
    if missing and _has_apt():
        missing = _install(missing, purpose)
    _judge(missing, purpose, strict and _has_apt())
    return [need.name for need in missing]


def find_missing(purpose: str) -> Missing:
    """Needs of the purpose that are missing; a render needs one OpenGL route, not two."""
    tried = {need: need.probe() for need in WANTED[purpose]}
    missing = {need: reason for need, reason in tried.items() if reason}
    if purpose in ("render", "view") and not {EGL, OSMESA} <= missing.keys():
        return {need: why for need, why in missing.items() if need not in (EGL, OSMESA)}
    return missing


def required(missing: Missing, strict: bool, apt: bool) -> list[Need]:
    """The missing packages that stop the set-up; OSMesa is one where apt still has it.

    Where apt does not manage the system the probes may not know its ways: there glrt itself
    says what OpenGL it finds.
    """
    if strict:
        return [
            need for need in missing if need is not OSMESA or any(map(_is_known, need.packages))
        ]
    no_route = apt and {EGL, OSMESA} <= missing.keys()
    return [need for need in missing if need in (CXX, VENV) or (no_route and need is EGL)]


def _provide_elsewhere() -> list[str]:
    if reason := probes.venv():
        steps.fail(f"{reason}: install Python from python.org or from your package manager.")
    steps.say("OpenGL comes with this system or its graphics driver: there is nothing to install.")
    return []


def _has_apt() -> bool:
    return bool(shutil.which("apt-get") and shutil.which("dpkg"))


def _install(missing: Missing, purpose: str) -> Missing:
    rights = _rights()
    if rights is None:
        return missing
    apt = [*rights, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq"]
    steps.run("System packages: apt-get update", [*apt, "update"])
    packages = _packages(missing)
    names = [name for name in packages if _is_known(name)] or packages
    options = ["--no-install-recommends", "--no-remove", "-o", "DPkg::Lock::Timeout=300", "-y"]
    title = f"System packages: apt-get install {' '.join(names)}"
    done, printed = steps.run(title, [*apt, *options, "install", *names])
    if not done:
        steps.say(steps.paragraph(f"apt-get failed: {steps.gist(printed)}"))
    return find_missing(purpose)


def _rights() -> list[str] | None:
    """The words that come before a command that installs; None where nobody gave the right."""
    if os.geteuid() == 0:
        return []
    sudo = shutil.which("sudo")
    if not sudo:
        return None
    asked = subprocess.run([sudo, "-n", "true"], stdin=subprocess.DEVNULL, capture_output=True)
    return [sudo, "-n"] if asked.returncode == 0 else None


def _packages(missing: Missing) -> list[str]:
    return list(dict.fromkeys(name for need in missing for name in need.packages))


def _is_known(package: str) -> bool:
    """Newer systems have dropped some packages: one unknown name would stop all the others."""
    shown = subprocess.run(["apt-cache", "show", package], capture_output=True)
    return shown.returncode == 0


def _judge(missing: Missing, purpose: str, strict: bool) -> None:
    if not missing:
        return
    lacking = required(missing, strict, _has_apt())
    text = f"{_describe(missing)}\n{_advice(missing)}"
    if lacking:
        steps.fail(f"Missing for `make {purpose}`: {text}")
    if set(missing) == {OSMESA} and not (_has_apt() and any(map(_is_known, OSMESA.packages))):
        text = f"{_describe(missing)} Mesa 25.1 removed it, and EGL does the same."
    steps.say(steps.paragraph(f"Going on without {text}"))


def _describe(missing: Missing) -> str:
    return "; ".join(f"{need.name} ({reason})" for need, reason in missing.items()) + "."


def _advice(missing: Missing) -> str:
    if not _has_apt():
        wishes = "; ".join(need.elsewhere for need in missing)
        return f"Install with the package manager of your system: {wishes}."
    packages = _packages(missing)
    names = " ".join([name for name in packages if _is_known(name)] or packages)
    sudo = "sudo " if os.geteuid() != 0 and shutil.which("sudo") else ""
    who = "" if sudo or os.geteuid() == 0 else " as root"
    command = f"{sudo}apt-get install --no-install-recommends {names}"
    return f"Type this{who}, then try again:\n    {sudo}apt-get update && {command}"
