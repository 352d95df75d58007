#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command if a file is there; otherwise says so and ends with 77, which CTest shows as
# skipped.
# Usage: if_present.sh FILE COMMAND...
set -euo pipefail
if [[ ! -e $1 ]]; then
    echo "skipped: there is no $1"
    exit 77
fi
shift
exec "$@"
