#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs a compiler by ccache as outside of CTest, whose variables of the locale ccache would take for
# another language of the compiler's messages.
exec env -u LC_ALL -u LC_MESSAGES ccache "$@"
