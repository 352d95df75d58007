// SPDX-License-Identifier: Apache-2.0
#include "render/first_pass.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "output_files.h"
#include "printable.h"
#include "render/render_options.h"
#include "sequence/frame_name.h"
#include "sequence/frames_to_make.h"
#include "sequence/sequence_look.h"
#include "text/utf8_text.h"

namespace deltasplat {
namespace {

constexpr const char* kFirstPass = "deltasplat_first_pass";
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

// A number by which one file is told from another of its name, nearly always: of its size, its
// first bytes and its last. Of what is no file, or cannot be read, it is 0. Based on: the hash
// FNV-1a (Fowler, Noll, Vo).
std::uint64_t markOf(const std::filesystem::path& file) {
    constexpr std::uint64_t kBytes = 65536;
    std::error_code ignored;
    std::ifstream in(file, std::ios::binary);
    if (!std::filesystem::is_regular_file(file, ignored) || !in) return 0;
    const std::uint64_t size = std::filesystem::file_size(file, ignored);
    std::uint64_t mark = 0xcbf29ce484222325;
    const auto add = [&](const std::string& bytes) {
        for (const char byte : bytes)
            mark = (mark ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    };
    add(std::to_string(size));
    std::string bytes(std::size_t(std::min(size, kBytes)), '\0');
    for (const std::uint64_t at : {std::uint64_t(0), size - bytes.size()}) {
        in.seekg(std::streamoff(at));
        if (!in.read(bytes.data(), std::streamsize(bytes.size()))) return 0;
        add(bytes);
    }
    return mark;
}

std::filesystem::path fileOf(const RenderCommand& command, int frame) {
    const std::optional<FrameName> name = FrameName::findInput(command.input);
    return name ? name->at(frame) : command.input;
}

// The first frame's file, if it is no longer the one that a first pass was made of; else empty.
std::filesystem::path otherFile(const Json& json, const RenderCommand& command) {
    if (!json.contains(kFirstFile) || json.at(kFrames).empty()) return {};
    const auto then = json.at(kFirstFile).get<std::uint64_t>();
    std::filesystem::path file = fileOf(command, json.at(kFrames)[0][0].get<int>());
    const std::uint64_t now = markOf(file);
    return then != 0 && now != 0 && then != now ? file : std::filesystem::path();
}

// What was made of other frames, or of another thing, may not suit those in hand.
void warnOfOthers(const Json& json, const RenderCommand& command, const Listener& listener) {
    const std::string begin = "--first-pass: " + command.firstPass.string() + " was made ";
    const auto input = json.at(kInput).get<std::string>();
    const std::string name = inputName(command);
    if (input != name)
        return listener.warn(begin + "of " + input + ", and is taken as it is for " + name);
    if (const std::filesystem::path other = otherFile(json, command); !other.empty()) {
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
        const bool isKnown =
            std::any_of(json.at(kFrames).begin(), json.at(kFrames).end(),
                        [&](const Json& run) { return frame >= run.at(0) && frame <= run.at(1); });
        if (!isKnown) absent.push_back(frame);
    }
    if (absent.empty()) return;
    listener.warn(begin + "without frame " + std::to_string(absent.front()) +
                  (absent.size() > 1 ? " and " + std::to_string(absent.size() - 1) + " more" : "") +
                  ", and is taken as it is");
}

// The file that the first of the frames in hand shows if it has none: of a first pass' frames that
// are there the last before it, or else the first behind it.
std::filesystem::path heldFile(const Json& json, const std::vector<int>& frames,
                               const std::filesystem::path& input) {
    const std::optional<FrameName> name = FrameName::findInput(input);
    if (!name || !std::is_sorted(frames.begin(), frames.end())) return {};
    // A file may say anything.
    constexpr int kMostLooks = 1'000'000;
    int looks = 0;
    std::filesystem::path held;
    // Looks from `frame` to `end`, one after the other, until there is one.
    const auto look = [&](std::int64_t frame, std::int64_t end, int step) {
        for (; held.empty() && (end - frame) * step >= 0 && looks < kMostLooks;
             frame += step, ++looks)
            if (hasInput(name->at(int(frame)))) held = name->at(int(frame));
    };
    const Json& runs = json.at(kFrames);
    const std::int64_t first = frames.front();
    for (auto run = runs.rbegin(); run != runs.rend(); ++run)
        look(std::min<std::int64_t>(run->at(1).get<int>(), first - 1), run->at(0).get<int>(), -1);
    for (const Json& run : runs)
        look(std::max<std::int64_t>(run.at(0).get<int>(), first + 1), run.at(1).get<int>(), 1);
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
    std::ifstream in(file);
    if (!in) return {};
    try {
        const Json json = Json::parse(in).at(kFirstPass);
        look.takeJson(json);
        warnOfOthers(json, command, listener);
        if (command.frames.missing != MissingFrames::kHold) return std::filesystem::path();
        return heldFile(json, command.frames.frames, command.input);
    } catch (const std::exception&) {
        throw Error(ErrorCode::kInput,
                    gotExpected(file.string(), "something else", "what --first-pass has written"));
    }
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
