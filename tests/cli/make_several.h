// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Writes files with several volumes, and a DICOM folder with several series, into the current
/// folder.
void writeSeveral();
