// SPDX-License-Identifier: Apache-2.0
#include "render/annotation_options.h"

#include <string>

#include "base/refuse.h"
#include "deltasplat/error.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

// The first option that asks for something, or none.
std::string anyOf(const AnnotationChoice& choice) {
    if (choice.legend) return "--legend";
    if (choice.scaleBar) return "--scale-bar";
    if (choice.axes) return "--axes";
    return choice.lines.empty() ? "" : "--annotate";
}

Parser<std::string> someText() {
    return [](const std::string& option, const std::string& text) {
        if (text.find_first_not_of(" \t") == std::string::npos)
            refuseUsage(option, text.empty() ? "nothing" : "spaces", "a line of text");
        return text;
    };
}

}  // namespace

void addAnnotationOptions(CLI::App& app, AnnotationChoice& choice) {
    OptionGroup group(app, "Annotations");
    group.addFlag("--legend", choice.legend,
                  "Draw into the picture (no .exr), upper right, which colours stand for which\n"
                  "values, and beside them how opaque these are (as its square\n"
                  "root); of labels their names, if --tf has some");
    group.addFlag("--scale-bar", choice.scaleBar,
                  "Draw a bar of a round length in world units, lower right (mm in\n"
                  "a patient's space; of --projection perspective that at the\n"
                  "target's distance)");
    group.addFlag("--axes", choice.axes,
                  "Draw the world's axes as the camera sees them, lower left: x, y\n"
                  "and z, or what of a patient they point to (R, L, A, P, S)");
    group.addEach("--annotate", "TEXT", choice.lines, someText(),
                  "Draw a line of text, upper left; may be given several times");
}

void checkAnnotations(const RenderCommand& command) {
    const AnnotationChoice& choice = command.annotations;
    const std::string any = anyOf(choice);
    if (!any.empty() && (isExr(command) || storesValues(command))) {
        refuseUsage(any, command.output.string() + ", whose pixels are light or values alone",
                    "a .png (render to both)");
    }
    const RenderOptions& render = command.picture.render;
    if (choice.scaleBar && render.camera.projection == Projection::kLatlong)
        refuseUsage("--scale-bar", "--projection latlong",
                    "ortho or perspective, where it would hold");
    if (!choice.legend) return;
    if (render.mode == Mode::kXray || render.mode == Mode::kDrr)
        refuseUsage("--legend",
                    "--mode " + modeName(render.mode) + ", which shows sums and no values",
                    "composite, mip, min or average");
    if (command.picture.surface.isovalue || command.picture.surface.asked)
        refuseUsage("--legend", "a surface, which has one colour", "a picture of values");
    if (render.mode == Mode::kComposite && render.optics.colorBy != ColorBy::kValue)
        refuseUsage("--legend", "--color-by " + colorByName(render.optics.colorBy), "value");
}

}  // namespace deltasplat
