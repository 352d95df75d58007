// SPDX-License-Identifier: Apache-2.0
#include "ingest/itk_calls.h"

#include <gdcmTrace.h>
#include <itkMacro.h>
#include <itkObject.h>

#include <iostream>
#include <mutex>
#include <new>
#include <sstream>
#include <string>

#include "deltasplat/error.h"
#include "printable.h"

namespace deltasplat {
namespace {

// MetaIO reports what it dislikes on standard error and leaves it at that. While one of these
// lives, what is written to the C++ streams is dropped.
class Silence {
  public:
    Silence() : lock_(mutex()), err_(std::cerr.rdbuf(nullptr)), out_(std::cout.rdbuf(nullptr)) {
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

  private:
    static std::mutex& mutex() {
        static std::mutex mutex;
        return mutex;
    }
    std::lock_guard<std::mutex> lock_;
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
    for (const char* const sign : {"): ", ": "}) {
        const std::size_t end = reason.find(sign);
        if (end != std::string::npos) return reason.substr(end + std::string(sign).size());
    }
    return reason;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) {
    throw Error(
        ErrorCode::kInput,
        gotExpected(file.string(), "what ITK refuses (" + printable(reason) + ")", "a sound file"));
}

}  // namespace

void callItk(const std::filesystem::path& file, const std::function<void()>& work) {
    const Silence silence;
    try {
        work();
    } catch (const itk::ExceptionObject& error) {
        refuse(file, reasonOf(error.GetDescription()));
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse(file, reasonOf(error.what()));
    }
}

}  // namespace deltasplat
