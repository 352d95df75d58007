// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace deltasplat {

enum class LogLevel { kInfo, kWarning, kError };

/// Opens a file to whose end lines are added that say what this process does; several processes may
/// share it. For the whole process, once, before there are threads.
/// @param asJson  whether each line is a JSON object
/// @throw Error(kUsage) if it holds anything but a log; Error(kOutput) if it cannot be written
void openRunLog(const std::filesystem::path& file, bool asJson);

/// Returns the file; empty: there is no log.
std::filesystem::path runLogFile();

/// Closes the log, whose name is that of another file of the command; it goes if this process has
/// made it and nobody else has written to it.
void dropRunLog();

/// Adds a line, with the time (UTC) and the process' number; without a log, nothing. Thread-safe.
/// What cannot be written is lost: no picture fails for it.
void logLine(LogLevel level, const std::string& text);

/// Adds the last line: the exit code, seconds of wall clock and of processors, most bytes held. Of
/// lines that could not be written it warns, on standard error.
void logEnd(int exitCode);

}  // namespace deltasplat
