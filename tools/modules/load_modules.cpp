// SPDX-License-Identifier: Apache-2.0
// Modules lie where the program's installation has them, as seen from the program itself.
#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "deltasplat/error.h"
#include "modules/image_module.h"
#include "modules/medical_module.h"
#include "printable.h"

namespace deltasplat {
namespace {

template <typename Module>
const Module& load(const char* name) {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    const std::filesystem::path file =
        (program.parent_path() / DELTASPLAT_MODULES / (std::string(name) + ".so"))
            .lexically_normal();
    void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto module = reinterpret_cast<const Module* (*)()>(
        library ? ::dlsym(library, "deltasplat_module") : nullptr);
    if (module) return *module();
    const char* const why = ::dlerror();
    throw Error(ErrorCode::kFailed,
                gotExpected("module " + std::string(name), printable(why ? why : "nothing"),
                            file.string() + ", which is installed with the program"));
}

}  // namespace

const ImageModule& imageModule() {
    static const ImageModule& module = load<ImageModule>("images");
    return module;
}

const MedicalModule& medicalModule() {
    static const MedicalModule& module = load<MedicalModule>("medical");
    return module;
}

}  // namespace deltasplat
