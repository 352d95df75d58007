// SPDX-License-Identifier: Apache-2.0
#include "render/slab_options.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "options/parse.h"
#include "output_files.h"
#include "render/picture_metadata.h"

namespace deltasplat {
namespace {

// Of the progress, what making a scene ready takes.
constexpr double kPrepareShare = 0.2;

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// What a share can be, of as many as the text says if it says that.
std::string expectedShares(const std::string& text) {
    const std::string most = std::to_string(kMostSlabShares);
    try {
        const auto count = wholeNumber(1, kMostSlabShares)(
            "", text.substr(std::min(text.find('/'), text.size() - 1) + 1));
        const std::string of = "/" + std::to_string(count);
        return "one of parts 1" + of + " to " + std::to_string(count) + of + ", or several, 1-" +
               std::to_string(count) + of;
    } catch (const Error&) {
        return "a part of so many, 1/4 to 4/4, or several, 2-3/4, of at most " + most;
    }
}

SlabShare parseShare(const std::string& option, const std::string& text) {
    const auto whole = wholeNumber(1, kMostSlabShares);
    try {
        const std::vector<std::string> ofAll = splitAt(text, '/');
        if (ofAll.size() == 2) {
            const std::vector<std::string> ends = splitAt(ofAll[0], '-');
            const SlabShare share{int(whole(option, ends.front())), int(whole(option, ends.back())),
                                  int(whole(option, ofAll[1]))};
            if (ends.size() <= 2 && share.first <= share.last && share.last <= share.count)
                return share;
        }
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage, option, text, expectedShares(text));
}

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "--slab-range", got, expected);
}

// Names of an option as users write it.
std::string nameOf(const CLI::Option& option) {
    return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

// What a picture is made with, in the order of the help: not what it is read from, for tasks may
// have other names for that, nor what changes no pixel.
Notes optionsOf(const CLI::App& app) {
    Notes notes;
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = nameOf(*option);
        const bool isOfPicture =
            option->count() > 0 && option->get_group() != std::string(kCommonTitle) &&
            !option->get_positional() && !contains({"--output", "--slab-range", "--confine"}, name);
        if (!isOfPicture) continue;
        std::string text;
        for (const std::string& value : option->results())
            text += (text.empty() ? "" : " ") + value;
        notes.emplace_back(name, text);
    }
    return notes;
}

}  // namespace

void addSlabOption(CLI::App& app, std::optional<SlabShare>& slabs) {
    OptionGroup group(app, "Output");
    group.addValue("--slab-range", "I/N", slabs, Parser<SlabShare>(parseShare),
                   "Render the Ith of N parts of the picture, cut in depth, or parts\n"
                   "I-J/N, into a .slabs file; 'deltasplat fold' makes the picture\n"
                   "of all parts");
}

void applySlabs(const CLI::App& app, const RenderCommand& command) {
    if (!command.slabs) return;
    const std::vector<std::string> ofFold = {
        "--float",        "--bits",        "--dither",        "--exposure",   "--tone",
        "--ocio",         "--look",        "--working-space", "--colorspace", "--display",
        "--display-view", "--compression", "--autocrop",      "--region",     "--background"};
    const std::vector<std::string> used = {"--output", "--overscan", "--slab-range"};
    if (!command.firstPass.empty())
        refuse("--first-pass besides", "it alone: each part reads the whole volume");
    for (const CLI::Option* option : app.get_options()) {
        if (option->count() == 0) continue;
        const std::string name = nameOf(*option);
        if (contains(ofFold, name)) refuse(name + " besides", name + " of 'deltasplat fold'");
        const std::string& group = option->get_group();
        const bool isOther = group == "Output" || group == "Sequence" || group == "Annotations" ||
                             name == "--ground" || name == "--window";
        if (isOther && !contains(used, name)) refuse(name + " besides", "one of the two");
    }
    if (command.picture.join.value_or(1) > 2)
        refuse("--join " + std::to_string(*command.picture.join), "--join 1 or 2");
    if (command.picture.render.mode != Mode::kComposite)
        refuse("--mode " + modeName(command.picture.render.mode), "--mode composite");
    if (lowerCase(command.output.extension().string()) != ".slabs")
        refuse("--output " + command.output.string(), "a .slabs file");
}

void writeSlabs(const CLI::App& app, const RenderCommand& command, const ReadScene& scene,
                const Session& session, const Listener& listener) {
    SplatOptions splat = scene.options.splat;
    splat.mostJoined = joinOfMany(command.picture);
    const PreparedScene prepared({scene.volume, scene.options.optics}, splat);
    // Of all grids of a medium.
    const Volume& seen = *prepared.scene().volume;
    const Camera camera = makeCamera(scene.options.camera, seen);
    const SlabPicture picture(prepared, camera, partOf(listener, 0, kPrepareShare));
    const CodeText codes = codesOf(*scene.volume);
    PartNotes notes{optionsOf(app), commonMetadata(session)};
    notes.picture.insert(notes.picture.begin(), notes.part.front());
    notes.picture.insert(notes.picture.end(),
                         {{"codeBook", codes.book}, {"codeError", codes.error}});
    notes.part.emplace_back("input", command.input.string());
    writeSlabs(picture, *command.slabs, notes, command.output, partOf(listener, kPrepareShare, 1));
}

}  // namespace deltasplat
