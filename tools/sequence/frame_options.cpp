// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_options.h"

#include <map>
#include <optional>

#include "deltasplat/error.h"
#include "formats/input_files.h"
#include "options/command_line.h"
#include "sequence/frame_list.h"
#include "sequence/frame_name.h"

namespace deltasplat {
namespace {

Parser<MissingFrames> missingFrames(const std::vector<std::string>& words) {
    return [words](const std::string& option, const std::string& text) {
        const std::string word = choice(words)(option, text);
        return word == "skip"    ? MissingFrames::kSkip
               : word == "hold"  ? MissingFrames::kHold
               : word == "black" ? MissingFrames::kBlack
                                 : MissingFrames::kError;
    };
}

constexpr const char* kFrameName = "a name with ####, %04d, @ or $F4 for the number";

[[noreturn]] void refuseName(const FrameChoice& choice, const std::string& option,
                             const std::filesystem::path& name) {
    throw Error(ErrorCode::kUsage, option, name.string() + " with " + choice.askedBy, kFrameName);
}

void sayFolder(const FrameName& name, const std::string& option, const Listener& listener) {
    if (name.folder().empty()) return;
    listener.warn(option + ": the frame's number stands in the name of the folder " +
                  name.folder() + ", for there is none of that very name");
}

void refuseOptionsOfFrames(const CLI::App& app) {
    for (const char* option : {"--missing", "--keep-going", "--skip-existing", "--update"}) {
        if (app.get_option_no_throw(option) && isGiven(app, option)) refuseWithoutFrames(option);
    }
}

[[noreturn]] void refuseAlone(const std::string& option, const std::filesystem::path& file) {
    throw Error(ErrorCode::kUsage, option, file.string() + " without --frames",
                "--frames with it, as in --frames 1-100");
}

}  // namespace

FrameName frameNameOf(const FrameChoice& choice, const std::string& option,
                      const std::filesystem::path& file) {
    const std::optional<FrameName> found = FrameName::find(file);
    if (found) return *found;
    std::filesystem::path named = file.filename();
    named.replace_extension(".####" + file.extension().string());
    throw Error(ErrorCode::kUsage, option, file.string() + " with " + choice.askedBy,
                std::string(kFrameName) + ", such as " + named.string());
}

void refuseWithoutFrames(const std::string& option) {
    throw Error(ErrorCode::kUsage, option, "it without --frames", "the frames of a sequence");
}

void addFrameOptions(CLI::App& app, FrameChoice& choice, bool arePictures) {
    OptionGroup group(app, "Sequence");
    group.addValue("--frames", "LIST", choice.frames, frameList(),
                   "Frames to work on: 1-100, 1-100x2 (every second), 100-1, -5--1,\n"
                   "1,4,10-20. INPUT and output have ####, %04d, @@@@ or $F4 where the\n"
                   "number stands (in the name of an image stack $F4 or @@@@)");
    std::vector<std::string> words{"error", "skip", "hold"};
    if (arePictures) words.emplace_back("black");
    group.addValue("--missing", arePictures ? "error|skip|hold|black" : "error|skip|hold",
                   choice.missing, missingFrames(words),
                   std::string("Of frames without a file: they have failed, nothing is made of "
                               "them,\nthey repeat the one before; of the first ones, the next "
                               "there is") +
                       (arePictures ? ";\nor are black, or --background" : "") +
                       "\n(default error)");
    group.addFlag("--keep-going", choice.keepGoing,
                  "Work on the other frames if one has failed; the exit code is that of\n"
                  "the first that has");
    group.addFlag("--skip-existing", choice.skipExisting,
                  "Leave out frames whose output is there; one that cannot be read is\n"
                  "made anew");
    group.addFlag("--update", choice.update,
                  "Leave out frames whose output is there and no older than the input");
}

void addFrameList(CLI::App& app, FrameChoice& choice) {
    OptionGroup group(app, "Sequence");
    group.addValue("--frames", "LIST", choice.frames, frameList(),
                   "Frames to look at, as 1-100, 1-100x2, 1,4,10-20; files have ####,\n"
                   "%04d, @@@@ or $F4 where the number stands (image stacks $F4 or @@@@)");
    group.addValue("--missing", "error|skip", choice.missing, missingFrames({"error", "skip"}),
                   "Of frames without a file: they have failed, or are passed over\n"
                   "(default error)");
}

std::vector<FrameFiles> inputsOfFrames(const FrameChoice& choice, const std::string& option,
                                       const std::filesystem::path& input,
                                       const Listener& listener) {
    const std::optional<FrameName> name = FrameName::findInput(input);
    if (!name) refuseName(choice, option, input);
    sayFolder(*name, option, listener);
    std::vector<FrameFiles> files;
    for (const int frame : choice.frames) files.push_back({frame, name->inputAt(frame), {}});
    return files;
}

std::vector<FrameFiles> filesOfFrames(const FrameChoice& choice, const std::filesystem::path& input,
                                      bool mayStand, const std::string& outputOption,
                                      const std::filesystem::path& output,
                                      const Listener& listener) {
    const std::optional<FrameName> inputName = FrameName::findInput(input);
    if (!inputName && !mayStand) refuseName(choice, "INPUT", input);
    const FrameName outputName = frameNameOf(choice, outputOption, output);
    if (inputName) sayFolder(*inputName, "INPUT", listener);
    sayFolder(outputName, outputOption, listener);
    std::vector<FrameFiles> files;
    std::map<std::filesystem::path, int> outputs;
    for (const int frame : choice.frames) {
        files.push_back(
            {frame, inputName ? inputName->inputAt(frame) : input, outputName.at(frame)});
        const auto [known, isNew] = outputs.emplace(files.back().output, frame);
        if (isNew) continue;
        throw Error(ErrorCode::kUsage, outputOption,
                    known->first.string() + " for frames " + std::to_string(known->second) +
                        " and " + std::to_string(frame),
                    "a file for each");
    }
    return files;
}

void settleNames(const CLI::App& app, const FrameChoice& choice, std::filesystem::path& input) {
    const bool hasPlace = FrameName::findInput(input).has_value();
    if (!choice.asked()) {
        refuseOptionsOfFrames(app);
        if (hasPlace) refuseAlone("INPUT", input);
    }
    if (!hasPlace) input = plainInput(input);
}

void settleNames(const CLI::App& app, const FrameChoice& choice, std::filesystem::path& input,
                 std::filesystem::path& output) {
    settleNames(app, choice, input);
    if (choice.asked()) return;
    // A single # or @ may be just a letter.
    const std::string signs = maskedEscapes(output.filename().string());
    const auto holds = [&](const char* place) { return signs.find(place) != std::string::npos; };
    if (holds("##") || holds("%0") || holds("$F"))
        refuseAlone(app.get_option_no_throw("--output") ? "--output" : "OUTPUT", output);
    output = plainName(output);
}

}  // namespace deltasplat
