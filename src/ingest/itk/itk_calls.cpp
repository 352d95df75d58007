// SPDX-License-Identifier: Apache-2.0
#include "ingest/itk/itk_calls.h"

#include "ingest/itk/itk_compiler.h"

#include <gdcmTrace.h>
#include <itkMacro.h>
#include <itkObject.h>

#include <iostream>
#include <mutex>
#include <new>
#include <sstream>
#include <string>

#include "deltasplat/error.h"
#include "ingest/guards/cleared_memory.h"
#include "printable.h"

namespace deltasplat {
namespace {

// MetaIO writes what it dislikes to standard error, and sometimes leaves it at that. While one of
// these lives, the C++ streams write here.
class Silence {
  public:
    Silence()
        : lock_(mutex()),
          err_(std::cerr.rdbuf(text_.rdbuf())),
          out_(std::cout.rdbuf(text_.rdbuf())) {
        itk::Object::SetGlobalWarningDisplay(false);
        gdcm::Trace::DebugOff();
        gdcm::Trace::WarningOff();
        gdcm::Trace::ErrorOff();
    }
    ~Silence() {
        std::cerr.rdbuf(err_);
        std::cout.rdbuf(out_);
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

    /// Returns the first line that was written, or no text.
    std::string complaint() const {
        std::istringstream lines(text_.str());
        for (std::string line; std::getline(lines, line);) {
            if (line.find_first_not_of(" \t\r") != std::string::npos) return line;
        }
        return "";
    }

  private:
    static std::mutex& mutex() {
        static std::mutex mutex;
        return mutex;
    }
    std::lock_guard<std::mutex> lock_;
    std::ostringstream text_;
    std::streambuf* err_;
    std::streambuf* out_;
};

// ITK's texts name its class and an address, then the reason; those of NRRD are a stack of lines
// of which the last is the cause.
std::string reasonOf(const std::string& text) {
    std::istringstream lines(text);
    std::string reason = "no reason given";
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("[nrrd] ", 0) == 0) line = line.substr(7);
        if (line.find_first_not_of(' ') != std::string::npos) reason = line;
    }
    for (const std::string sign : {"): ", ": "}) {
        const std::size_t end = reason.find(sign);
        if (end == std::string::npos) continue;
        reason = reason.substr(end + sign.size());
        break;
    }
    if (!reason.empty() && reason.back() == '.') reason.pop_back();
    return reason;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) {
    throw Error(
        ErrorCode::kInput,
        gotExpected(file.string(), "what ITK refuses (" + printable(reason) + ")", "a sound file"));
}

}  // namespace

void callItk(const std::filesystem::path& file, Printed printed,
             const std::function<void()>& work) {
    const Silence silence;
    const ClearedMemory cleared;
    try {
        work();
    } catch (const itk::ExceptionObject& error) {
        // The reason that ITK adds to MetaIO's failures is whatever the system said last.
        const std::string complaint = silence.complaint();
        const bool metaIo = printed == Printed::kIsError && !complaint.empty();
        refuse(file, reasonOf(metaIo ? complaint : error.GetDescription()));
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse(file, reasonOf(error.what()));
    }
    const std::string complaint = silence.complaint();
    if (printed == Printed::kIsError && !complaint.empty()) refuse(file, reasonOf(complaint));
}

}  // namespace deltasplat
