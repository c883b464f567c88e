"""Hints on what to install or set where OpenGL does not work, by system."""

import os
import platform
import sys
from pathlib import Path

REMEDIES = {
    "Debian, Ubuntu": "apt-get install libgl1 libegl1 libegl-mesa0 libgl1-mesa-dri (EGL with "
    "software OpenGL), xvfb (hidden windows); for a GPU its driver",
    "Fedora": "dnf install mesa-libEGL mesa-libGL mesa-dri-drivers (EGL with software OpenGL), "
    "xorg-x11-server-Xvfb (hidden windows); for a GPU its driver",
    "Arch": "pacman -S mesa (EGL with software OpenGL), xorg-server-xvfb (hidden windows); for a "
    "GPU its driver",
    "macOS": "nothing to install: the window route has OpenGL 4.1, for the fragment pipeline; it "
    "needs a session with a screen",
    "Windows": "the graphics card's driver from its maker; without a card, Mesa's opengl32.dll "
    "next to python.exe",
    "Docker": "in the image, the packages of its distribution as above; for a GPU run with "
    "--gpus all, the NVIDIA container toolkit and NVIDIA_DRIVER_CAPABILITIES=all",
    "hosted CI": "a step that installs the packages above with sudo; there is no GPU, and none is "
    "needed",
}
_BY_ID = {
    "debian": "Debian, Ubuntu",
    "ubuntu": "Debian, Ubuntu",
    "fedora": "Fedora",
    "arch": "Arch",
    "archlinux": "Arch",
}


def systems_here(release: str | None = None) -> list[str]:
    """Return the keys of REMEDIES that fit this machine; `release`: text of /etc/os-release."""
    if sys.platform in ("darwin", "win32"):
        found = [{"darwin": "macOS", "win32": "Windows"}[sys.platform]]
    else:
        found = [_linux(_release() if release is None else release)]
    if Path("/.dockerenv").exists():
        found.append("Docker")
    if os.environ.get("CI"):
        found.append("hosted CI")
    return [name for name in found if name]


def remedies() -> list[str]:
    """Return a line for each system that fits this machine; for all if its system is unknown."""
    here = systems_here()
    known = [name for name in here if name not in ("Docker", "hosted CI")]
    return [f"{name}: {REMEDIES[name]}." for name in (here if known else REMEDIES)]


def _release() -> str:
    try:
        return "\n".join(
            f"{key}={value}" for key, value in platform.freedesktop_os_release().items()
        )
    except OSError:
        return ""


def _linux(release: str) -> str:
    fields = dict(line.split("=", 1) for line in release.splitlines() if "=" in line)
    names = f"{fields.get('ID', '')} {fields.get('ID_LIKE', '')}".replace('"', "").split()
    return next((_BY_ID[name] for name in names if name in _BY_ID), "")
