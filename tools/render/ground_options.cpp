// SPDX-License-Identifier: Apache-2.0
#include "render/ground_options.h"

#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/parse.h"
#include "render/render_input.h"

namespace deltasplat {
namespace {

GroundChoice parseGround(const std::string& option, const std::string& text) {
    const std::vector<std::string> parts = splitAt(text, ':');
    GroundChoice ground;
    try {
        ground.pointWorld = vector3()(option, parts[0]);
        if (parts.size() == 2) ground.normalWorld = vector3()(option, parts[1]);
        if (parts.size() <= 2 && ground.normalWorld != glm::dvec3(0)) return ground;
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage, option, text,
                "X,Y,Z, a point of the ground, then, if wanted, :NX,NY,NZ, its normal, "
                "not all 0, as in 0,-10,0:0,1,0");
}

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "--ground", got, expected);
}

}  // namespace

void addGroundOption(CLI::App& app, std::optional<GroundChoice>& choice) {
    OptionGroup group(app, "Light in fog");
    group.addValue("--ground", "X,Y,Z[:NX,NY,NZ]", choice, Parser<GroundChoice>(parseGround),
                   "Point of a plane that the volume throws its shadow on, and its normal\n"
                   "(default: what is up, as for --sky): the shadow lies under the\n"
                   "picture, black of its alpha, to be put over a photograph, or in\n"
                   "channels, with --aov shadow");
}

void checkGround(const RenderCommand& command) {
    if (command.channels.shadow && !command.ground) {
        throw Error(ErrorCode::kUsage, "--aov shadow", "no --ground",
                    "--ground X,Y,Z, a point of what it falls on");
    }
    if (!command.ground) return;
    const Mode mode = command.picture.render.mode;
    if (mode != Mode::kComposite) refuse("--mode " + modeName(mode), "--mode composite");
    if (!command.picture.scatter.asked())
        refuse("what shines by itself", "--lighting scatter, whose lights throw shadows");
    if (command.deep) refuse("--deep besides", "a flat picture, or --deep alone");
    if (!command.holdoutDepth.empty()) refuse("--holdout-depth besides", "one of the two");
}

void addGroundShadow(const RenderCommand& command, const Volume& volume,
                     const RenderOptions& options, RenderResult& result, ImageFileOptions& image,
                     const Listener& listener) {
    if (!command.ground) return;
    const glm::dvec3 up = command.ground->normalWorld.value_or(upOf(command.picture, volume));
    const Ground ground{command.ground->pointWorld, up};
    image.metadata.emplace_back(
        "ground", numberText(ground.pointWorld) + ":" + numberText(ground.normalWorld));
    const Image shadow = renderGroundShadow(volume, options, result.camera, ground, listener);
    if (!command.channels.shadow) return putShadowBehind(result.image, shadow);
    for (ImageChannel& channel : shadowChannels(shadow))
        image.channels.push_back(std::move(channel));
}

}  // namespace deltasplat
