// SPDX-License-Identifier: Apache-2.0
// Modules lie where the installation has them, as seen from the program.
#include "modules/load_modules.h"

#include <dlfcn.h>
#include <sys/auxv.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "modules/image_module.h"
#include "modules/module_version.h"
#include "modules/open_library.h"

namespace deltasplat {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kFailed, "module " + name, got,
                expected + ", installed with the program");
}

// What a module takes once it is loaded.
void requireMemoryOf(const std::string& name) {
    struct Library {
        const char* module;
        const char* name;
        double mebibytes;  // resident
    };
    static constexpr Library kLibraries[] = {{"openvdb", "OpenVDB's library", 28},
                                             {"images", "OpenImageIO's library", 112}};
    for (const Library& library : kLibraries)
        if (name == library.module) requireMemory(library.name, library.mebibytes * 0x1p20);
}

std::filesystem::path fileOf(const std::string& name) {
    std::error_code error;
    std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) {
        // Without /proc there is what the system was told to run.
        const auto* const called = std::bit_cast<const char*>(::getauxval(AT_EXECFN));
        std::error_code unknown = error;
        if (called) program = std::filesystem::canonical(called, unknown);
        if (unknown) refuse(name, "/proc/self/exe: " + error.message(), "the place of the program");
    }
    return (program.parent_path() / DELTASPLAT_MODULES / (name + ".so")).lexically_normal();
}

// An installation may be replaced while a program of the one before runs; and a file may have the
// name of another one.
void requireSameVersion(const std::string& name, const std::filesystem::path& file, void* library) {
    const std::string expected = DELTASPLAT_MODULE_VERSION + name;
    const auto* const version =
        static_cast<const char*>(::dlsym(library, "deltasplat_module_version"));
    const std::string got = version ? std::string(version, ::strnlen(version, 100)) : "no version";
    if (got != expected)
        refuse(name, file.string() + " of \"" + printable(got) + '"', '"' + expected + '"');
}

template <typename Module>
const Module& load(const char* name) {
    const auto module = reinterpret_cast<const Module* (*)()>(
        ::dlsym(openModule(name, RTLD_NOW), "deltasplat_module"));
    if (!module) refuse(name, "no functions", "a module");
    return *module();
}

}  // namespace

void* openModule(const char* name, int binding) {
    const std::filesystem::path file = fileOf(name);
    requireMemoryOf(name);
    void* const library = openLibrary(file.c_str(), binding | RTLD_LOCAL);
    if (!library) {
        const char* const why = ::dlerror();
        refuse(name, printable(why ? why : "nothing"), file.string());
    }
    requireSameVersion(name, file, library);
    return library;
}

const ImageModule& imageModule() {
    static const ImageModule& module = load<ImageModule>("images");
    return module;
}

}  // namespace deltasplat
