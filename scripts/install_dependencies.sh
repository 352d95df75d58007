#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what building and testing deltasplat needs from Debian or Ubuntu packages.
# Usage: bash scripts/install_dependencies.sh [--to-build | --aarch64]
# With --to-build, leaves out what only running the checks needs; with --aarch64, installs what the
# CMake preset aarch64 needs instead: a cross compiler, qemu and libraries of that architecture.
# Does nothing, not even on the network, when nothing is missing.
set -euo pipefail

tools=(g++ cmake ninja-build ccache git pkg-config)
headers=(libglm-dev libcli11-dev nlohmann-json3-dev)
# The CMake files of OpenImageIO and GDCM ask for their programs, used or not.
libraries=(
    libopenvdb-dev libboost-dev libboost-iostreams-dev libblosc-dev libimath-dev libtbb-dev
    libopenexr-dev libopenimageio-dev openimageio-tools libhwy-dev zlib1g-dev libgtest-dev
    libbenchmark-dev
)
packages=("${tools[@]}" "${headers[@]}")
case ${1:-} in
    --to-build) packages+=("${libraries[@]}" libgdcm-dev libgdcm-tools) ;;
    --aarch64) packages+=(g++-aarch64-linux-gnu qemu-user "${libraries[@]/%/:arm64}") ;;
    '') packages+=("${libraries[@]}" libgdcm-dev libgdcm-tools clang-format clang-tidy
        shellcheck python3 debootstrap debian-archive-keyring) ;;
    *)
        echo "install_dependencies.sh: got $1; expected nothing, --to-build or --aarch64" >&2
        exit 2
        ;;
esac

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
if [[ ${1:-} == --aarch64 ]]; then "${as_root[@]}" dpkg --add-architecture arm64; fi
apt_get update
apt_get install -y --no-install-recommends "${missing[@]}"
