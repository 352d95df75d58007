// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a module and the program that loads it have to agree on, for C++ objects pass between them.
/// A module exports it as `deltasplat_module_version`, with its name behind it.
#define DELTASPLAT_MODULE_VERSION "deltasplat module " DELTASPLAT_VERSION " "
