// SPDX-License-Identifier: Apache-2.0
// Based on: DICOM PS3.3, X-Ray Positioner Module: which way primary and secondary angles count.
#include "camera/poses.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "base/text.h"
#include "deltasplat/error.h"
#include "optics/located_json.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

struct Column {
    const char* name;
    double CArmPose::*member;
    bool isLength;
};
constexpr std::array<Column, 5> kColumns{{{"primary", &CArmPose::primaryDegrees, false},
                                          {"secondary", &CArmPose::secondaryDegrees, false},
                                          {"sid", &CArmPose::sourceToIsocenter, true},
                                          {"sdd", &CArmPose::sourceToDetector, true},
                                          {"pixel", &CArmPose::pixel, true}}};
constexpr const char* kNames = "primary,secondary,sid,sdd,pixel";

std::string trimmed(const std::string& text) {
    constexpr const char* kBlanks = " \t\r";
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

class PoseReader {
  public:
    explicit PoseReader(const std::filesystem::path& file)
        : file_(file), text_(readSmallText(file, "poses of a C-arm (CSV)")) {}

    std::vector<CArmPose> read() {
        std::vector<CArmPose> poses;
        std::string line;
        while (nextLine(line)) {
            const std::vector<std::string> cells = splitAt(line, ',');
            if (columns_.empty()) {
                readNames(cells);
            } else {
                poses.push_back(poseOf(cells));
            }
        }
        if (poses.empty()) fail(columns_.empty() ? "nothing" : "no poses", expectedLine());
        return poses;
    }

  private:
    [[noreturn]] void fail(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, file_.string() + ":" + std::to_string(std::max(line_, 1)),
                    got, expected);
    }

    std::string expectedLine() const {
        return columns_.empty() ? std::string("a line ") + kNames : "a line for each frame";
    }

    static std::string quoted(const std::string& text) {
        constexpr std::size_t kMost = 40;
        return '"' + printable(text.substr(0, kMost)) + (text.size() > kMost ? "..." : "") + '"';
    }

    // The next line that says something.
    bool nextLine(std::string& line) {
        while (at_ < text_.size()) {
            const std::size_t end = std::min(text_.find('\n', at_), text_.size());
            line = trimmed(text_.substr(at_, end - at_));
            at_ = end + 1;
            ++line_;
            if (!line.empty() && line.front() != '#') return true;
        }
        return false;
    }

    void readNames(const std::vector<std::string>& cells) {
        for (const std::string& cell : cells) {
            const std::string name = trimmed(cell);
            const auto column = std::find_if(kColumns.begin(), kColumns.end(),
                                             [&](const Column& one) { return name == one.name; });
            if (column == kColumns.end()) fail("a column " + quoted(name), kNames);
            if (std::find(columns_.begin(), columns_.end(), &*column) != columns_.end())
                fail("two columns " + quoted(name), kNames);
            columns_.push_back(&*column);
        }
        for (const Column& one : kColumns)
            if (std::find(columns_.begin(), columns_.end(), &one) == columns_.end())
                fail(std::string("no column \"") + one.name + '"', kNames);
    }

    CArmPose poseOf(const std::vector<std::string>& cells) const {
        if (cells.size() != columns_.size()) {
            fail(std::to_string(cells.size()) + " numbers",
                 std::to_string(columns_.size()) + ", one for each column");
        }
        CArmPose pose;
        for (std::size_t i = 0; i < cells.size(); ++i)
            pose.*columns_[i]->member = numberOf(trimmed(cells[i]), *columns_[i]);
        if (pose.sourceToDetector < pose.sourceToIsocenter)
            fail("an sdd of " + numberText(pose.sourceToDetector),
                 "at least the sid, " + numberText(pose.sourceToIsocenter));
        return pose;
    }

    double numberOf(const std::string& text, const Column& column) const {
        constexpr double kMostLength = 1e9, kMostAngle = 360;
        double value = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, problem] = std::from_chars(text.data(), end, value);
        const bool isNumber = problem == std::errc() && stop == end;
        const bool isFine = column.isLength ? value >= 1 / kMostLength && value <= kMostLength
                                            : std::abs(value) <= kMostAngle;
        if (isNumber && isFine) return value;
        fail(quoted(text) + " for " + column.name,
             column.isLength ? "mm, a number > 0" : "degrees, a number from -360 to 360");
    }

    const std::filesystem::path& file_;
    std::string text_;
    std::size_t at_ = 0;
    int line_ = 0;
    std::vector<const Column*> columns_;
};

}  // namespace

std::vector<CArmPose> readPoses(const std::filesystem::path& file) {
    return PoseReader(file).read();
}

void applyPose(const CArmPose& pose, CameraOptions& camera) {
    camera.projection = Projection::kPerspective;
    camera.view = "back";
    camera.azimuthDegrees = pose.primaryDegrees;
    camera.elevationDegrees = -pose.secondaryDegrees;
    camera.rollDegrees = 0;
    camera.sourceToIsocenterWorld = pose.sourceToIsocenter;
    camera.sourceToDetectorWorld = pose.sourceToDetector;
    camera.detectorWorld = pose.pixel * glm::dvec2(camera.sizePixels);
}

}  // namespace deltasplat
