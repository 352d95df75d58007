#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Cross-compiles for 64-bit ARM in a fresh Debian 12 with packages of both architectures, and runs
# the tests of pixels under qemu. Needs root, and the network for packages.
# Usage: bash scripts/test_aarch64.sh
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/debian_root.sh"

tests=(portable_math_test default_floats_test golden_test footprint_test class_table_test
    transfer_function_test camera_test factorization_test sheet_test splatter_test
    tile_kernels_test layer_test ray_kernels_test warp_test)

inside() {
    make_root
    in_root "bash scripts/install_dependencies.sh --aarch64"
    in_root "cmake --preset aarch64"
    in_root "cmake --build --preset aarch64 --target ${tests[*]}"
    local name
    for name in "${tests[@]}"; do
        printf '\n== Under qemu-aarch64: %s\n' "$name"
        in_root "qemu-aarch64 build/aarch64/bin/$name --gtest_brief=1"
    done
    echo "== Done after $SECONDS s"
}

in_fresh_debian "$@"
