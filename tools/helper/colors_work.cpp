// SPDX-License-Identifier: Apache-2.0
// Makes the transforms of ColorOptions by OpenColorIO, for who asks to see that this ends no
// process.
#include "deltasplat/error.h"
#include "helper_work.h"
#include "modules/image_module.h"
#include "oiio/color_transforms.h"

bool deltasplat_helper_work(std::string_view request, std::string&, deltasplat::HelperNote note) {
    using namespace deltasplat;
    try {
        makeColorTransforms(
            colorOptionsOf(std::string(request)),
            [&](const std::string& option, const std::string&) { note(option + '\n'); });
    } catch (const Error&) {
        // Who asks meets the same.
    }
    return true;
}
