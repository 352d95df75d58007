#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what building and testing deltasplat needs from Debian or Ubuntu packages.
# Usage: bash scripts/install_dependencies.sh [--to-build]
# With --to-build, leaves out what only running the tests and the checks needs.
# Does nothing, not even on the network, when nothing is missing.
set -euo pipefail

packages=(
    g++ cmake ninja-build ccache git pkg-config
    libopenvdb-dev libboost-dev libboost-iostreams-dev libblosc-dev libimath-dev libtbb-dev
    libinsighttoolkit5-dev libopenimageio-dev libglm-dev libhwy-dev libcli11-dev nlohmann-json3-dev zlib1g-dev
    libgtest-dev libbenchmark-dev
)
if [[ ${1:-} != --to-build ]]; then
    packages+=(openimageio-tools clang-format clang-tidy)
fi

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $state == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
    echo "All ${#packages[@]} packages are installed."
    exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null || {
        echo "install_dependencies.sh: not root, and there is no sudo; please install" \
            "${missing[*]}" >&2
        exit 1
    }
    as_root=(sudo)
fi
apt_get() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -o DPkg::Lock::Timeout=600 "$@" </dev/null
}
echo "Installing ${missing[*]}"
apt_get update
apt_get install -y --no-install-recommends "${missing[@]}"
