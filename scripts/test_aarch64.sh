#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Cross-compiles for 64-bit ARM in a fresh Debian 12 with packages of both architectures, and runs
# the tests of pixels under qemu. Needs root, and the network for packages.
# With --seconds, nothing is compiled after so many; what was covered is then said in the last line.
# Usage: bash scripts/test_aarch64.sh [--seconds N]
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/debian_root.sh"

tests=(base_tests golden_tests optics_tests view_tests splat_tests)
# Of these, what pixels depend on.
suites='PortableMath*:DefaultFloats*:Golden*:Classify*:TransferFunction*:Camera*:Factorization*'
suites+=':Footprint*:Sheet*:Splatter*:*Tile*:CellWeights*:*Layer*:RayKernels*:Warp*:Simd/*'

[[ $# -eq 0 || ($# -eq 2 && $1 == --seconds && $2 =~ ^[0-9]+$) ]] ||
    fail "got $*; expected nothing or --seconds N"

inside() {
    local end=$((SECONDS + ${2:-86400})) name status=0 ran=0
    make_root
    in_root "bash scripts/install_dependencies.sh --aarch64"
    in_root "cmake --preset aarch64"
    in_root "timeout $((SECONDS < end ? end - SECONDS : 1)) \
        cmake --build --preset aarch64 --target ${tests[*]}" || status=$?
    [[ $status -eq 0 || $status -eq 124 ]] || exit "$status"
    for name in "${tests[@]}"; do
        [[ $status -eq 0 || -x $root/root/deltasplat/build/aarch64/bin/$name ]] || continue
        printf '\n== Under qemu-aarch64: %s\n' "$name"
        in_root "qemu-aarch64 build/aarch64/bin/$name --gtest_brief=1 --gtest_filter='$suites'"
        ran=$((ran + 1))
    done
    echo "== Done after $SECONDS s"
    if [[ $status -eq 124 ]]; then
        echo "COVERED: 64-bit ARM: $ran of ${#tests[@]} test programs"
    fi
}

in_fresh_debian "$@"
