// SPDX-License-Identifier: Apache-2.0
#include "render/first_pass.h"

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "files/checked_json.h"
#include "files/file_name.h"
#include "output_files.h"
#include "render/render_options.h"
#include "sequence/frame_name.h"
#include "sequence/frames_to_make.h"
#include "sequence/sequence_look.h"
#include "text/utf8_text.h"

namespace deltasplat {
namespace {

constexpr const char* kFirstPass = "deltasplat_first_pass";
constexpr const char* kWritten = "what --first-pass has written";
// In it, what it was made of.
constexpr const char* kInput = "input";
constexpr const char* kFrames = "frames";
constexpr const char* kOptions = "options";
constexpr const char* kFirstFile = "first_file";

using Json = nlohmann::ordered_json;

// Runs [first, last] of frames.
Json runsOf(std::vector<int> frames) {
    std::sort(frames.begin(), frames.end());
    Json runs = Json::array();
    for (const int frame : frames) {
        if (!runs.empty() && runs.back()[1] == frame - 1)
            runs.back()[1] = frame;
        else
            runs.push_back({frame, frame});
    }
    return runs;
}

// As a first pass names it: JSON is UTF-8, which a file's name need not be.
std::string inputName(const RenderCommand& command) {
    return utf8(codePoints(command.input.filename().string()));
}

std::filesystem::path fileOf(const RenderCommand& command, int frame) {
    const std::optional<FrameName> name = FrameName::findInput(command.input);
    return name ? name->at(frame) : command.input;
}

// First and last of each run of frames. A file may say anything.
std::vector<glm::ivec2> runsIn(const Json& json) {
    std::vector<glm::ivec2> runs;
    if (!json.at(kFrames).is_array() || json.at(kFrames).empty())
        throw Error(ErrorCode::kInput, "no list of frames");
    for (const Json& run : json.at(kFrames)) {
        runs.emplace_back(wholeNumberOf<int>(run.at(0)), wholeNumberOf<int>(run.at(1)));
        if (runs.back().x > runs.back().y) throw Error(ErrorCode::kInput, "a run of no frames");
    }
    return runs;
}

// The first frame's file, if it is no longer the one that a first pass was made of; else empty.
std::filesystem::path otherFile(const Json& json, const std::vector<glm::ivec2>& runs,
                                const RenderCommand& command) {
    if (!json.contains(kFirstFile)) return {};
    const auto then = wholeNumberOf<std::uint64_t>(json.at(kFirstFile));
    std::filesystem::path file = fileOf(command, runs.front().x);
    const std::uint64_t now = markOf(file);
    return then != 0 && now != 0 && then != now ? file : std::filesystem::path();
}

// What was made of other frames, or of another thing, may not suit those in hand.
void warnOfOthers(const Json& json, const std::vector<glm::ivec2>& runs,
                  const RenderCommand& command, const Listener& listener) {
    const std::string begin = "--first-pass: " + command.firstPass.string() + " was made ";
    const auto input = json.at(kInput).get<std::string>();
    const std::string name = inputName(command);
    if (input != name)
        return listener.warn(begin + "of " + input + ", and is taken as it is for " + name);
    if (const std::filesystem::path other = otherFile(json, runs, command); !other.empty()) {
        return listener.warn(begin + "of another " + printable(other.filename().string()) +
                             " than there is now, and is taken as it is");
    }
    const std::string options = json.value(kOptions, command.readingOptions);
    if (options != command.readingOptions) {
        const auto named = [](const std::string& text) {
            return text.empty() ? "no options that choose what is read" : "\"" + text + "\"";
        };
        return listener.warn(begin + "with " + named(options) + ", and is taken as it is for " +
                             named(command.readingOptions));
    }
    std::vector<int> absent;
    const std::optional<FrameName> files = FrameName::findInput(command.input);
    for (const int frame : command.frames.frames) {
        // It had none to be read, either.
        if (files && command.frames.missing != MissingFrames::kError && !hasInput(files->at(frame)))
            continue;
        const bool isKnown = std::any_of(runs.begin(), runs.end(), [&](const glm::ivec2& run) {
            return frame >= run.x && frame <= run.y;
        });
        if (!isKnown) absent.push_back(frame);
    }
    if (absent.empty()) return;
    listener.warn(begin + "without frame " + std::to_string(absent.front()) +
                  (absent.size() > 1 ? " and " + std::to_string(absent.size() - 1) + " more" : "") +
                  ", and is taken as it is");
}

// The file that the first of the frames in hand shows if it has none: of a first pass' frames that
// are there the last before it, or else the first behind it.
std::filesystem::path heldFile(const std::vector<glm::ivec2>& runs, const std::vector<int>& frames,
                               const std::filesystem::path& input) {
    const std::optional<FrameName> name = FrameName::findInput(input);
    if (!name || !std::is_sorted(frames.begin(), frames.end())) return {};
    constexpr int kMostLooks = 1'000'000;
    int looks = 0;
    std::filesystem::path held;
    // Looks from `frame` to `end`, one after the other, until there is one.
    const auto look = [&](std::int64_t frame, std::int64_t end, int step) {
        for (; held.empty() && (end - frame) * step >= 0 && looks < kMostLooks;
             frame += step, ++looks)
            if (hasInput(name->at(int(frame)))) held = name->inputAt(int(frame));
    };
    const std::int64_t first = frames.front();
    const std::vector<glm::ivec2> backwards(runs.rbegin(), runs.rend());
    for (const glm::ivec2& run : backwards)
        look(std::min<std::int64_t>(run.y, first - 1), run.x, -1);
    for (const glm::ivec2& run : runs) look(std::max<std::int64_t>(run.x, first + 1), run.y, 1);
    return held;
}

}  // namespace

std::string readingOptions(const CLI::App& app) {
    std::string text;
    for (const CLI::Option* option : app.get_options()) {
        const std::string& group = option->get_group();
        if (option->count() == 0 || !(group.starts_with("Input") || group == "Parts")) continue;
        text += (text.empty() ? "" : " ") + option->get_name();
        for (const std::string& value : option->results()) text += " " + value;
    }
    return utf8(codePoints(text));
}

std::optional<std::filesystem::path> readFirstPass(const RenderCommand& command, SequenceLook& look,
                                                   const Listener& listener) {
    const std::filesystem::path& file = command.firstPass;
    if (file.empty()) return {};
    std::error_code error;
    if (!std::filesystem::exists(file, error) && !error) return {};
    Json whole = readCheckedJson(file, kWritten);
    std::vector<glm::ivec2> runs;
    try {
        const Json json = std::move(whole.at(kFirstPass));
        look.takeJson(json);
        runs = runsIn(json);
        warnOfOthers(json, runs, command, listener);
    } catch (const std::exception&) {
        throw Error(ErrorCode::kInput, file.string(), "something else", kWritten);
    }
    if (command.frames.missing != MissingFrames::kHold) return std::filesystem::path();
    return heldFile(runs, command.frames.frames, command.input);
}

void requireWritableFirstPass(const RenderCommand& command) {
    OutputFolders folders;
    folders.makeFor(command.firstPass);
    const AtomicFile probe(command.firstPass);
}

void writeFirstPass(const RenderCommand& command, const std::vector<int>& frames,
                    const SequenceLook& look) {
    Json json{{kInput, inputName(command)},
              {kFrames, runsOf(frames)},
              {kOptions, command.readingOptions}};
    if (!frames.empty()) {
        const int first = *std::min_element(frames.begin(), frames.end());
        json[kFirstFile] = markOf(fileOf(command, first));
    }
    json.update(look.toJson());
    makeFolderOf(command.firstPass);
    writeFileAtomically(command.firstPass, Json{{kFirstPass, json}}.dump(1) + "\n");
}

}  // namespace deltasplat
