#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows that every test which tests/README.md names for a promise exists.
# Usage: promises.sh README BUILD_FOLDER
set -euo pipefail
tests=$(ctest --test-dir "$2" -N | sed -n 's/^ *Test *#[0-9]*: //p')
missing=0
while read -r name; do
    pattern=${name//./\\.}
    grep -Eq "(^|[./])${pattern//\*/.*}(\$|/)" <<<"$tests" && continue
    # What is skipped where a part of the library is left out is not there at all.
    [[ $name == Dicom* || $name == ReadDicom* ]] && continue
    echo "tests/README.md: got $name; expected the name of a test"
    missing=1
done < <(sed -n '/^## Which/,$p' "$1" | grep '^| ' | grep -oE '`[A-Za-z_]+\.[A-Za-z_.*]+`' | tr -d '`' | grep -v '\.cpp$' | sort -u)
exit $missing
