// SPDX-License-Identifier: Apache-2.0
// Based on: ImageJ's TiffEncoder and FileOpener (format of descriptions), its Calibration, and its
// hyperstack order (channels fastest, then slices, then frames).
#include "oiio/tiff_volume.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_name.h"
#include "formats/input_files.h"
#include "oiio/ome_planes.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

using Path = std::filesystem::path;

template <typename T>
std::optional<T> numberIn(const std::string& text) {
    T number{};
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, number);
    if (result.ec != std::errc{} || result.ptr != end) return {};
    return number;
}

struct Planes {
    std::int64_t slices = 1;
    std::int64_t volumes = 1;
    std::string axes;  // further axes, for messages
    std::function<std::int64_t(std::int64_t slice, std::int64_t volume)> at;
};

std::string axesText(std::int64_t channels, std::int64_t times) {
    return countText(channels, "channel") + ", " + countText(times, "time");
}

// A stack along a single axis is one volume, even if the axis is channels or times.
// @param at  maps slice, channel and time to a plane
Planes planesOf(const std::string& where, std::int64_t slices, std::int64_t channels,
                std::int64_t times,
                const std::function<std::int64_t(std::int64_t, std::int64_t, std::int64_t)>& at,
                const Listener& listener) {
    if (slices == 1 && channels > 1 && times == 1) {
        listener.warn(where + ": " + countText(channels, "channel") + " are read as slices");
        return {channels, 1, "", [at](auto i, auto) { return at(0, i, 0); }};
    }
    if (slices == 1 && channels == 1 && times > 1) {
        listener.warn(where + ": " + countText(times, "time") + " are read as slices");
        return {times, 1, "", [at](auto i, auto) { return at(0, 0, i); }};
    }
    return {slices, channels * times, axesText(channels, times),
            [at, channels](auto i, auto n) { return at(i, n % channels, n / channels); }};
}

std::map<std::string, std::string> linesOf(const std::string& text) {
    std::map<std::string, std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (line.ends_with('\r')) line.pop_back();
        const std::size_t equals = line.find('=');
        if (equals != std::string::npos)
            lines.emplace(line.substr(0, equals), line.substr(equals + 1));
    }
    return lines;
}

class ImageJ {
  public:
    ImageJ(const Path& file, const TiffPages& tiff)
        : file_(file), tiff_(tiff), lines_(linesOf(tiff.description)) {}

    std::int64_t images() const { return count("images", 1); }

    Planes planes(const Listener& listener) const {
        const std::int64_t channels = count("channels", 1), times = count("frames", 1);
        const bool isPlain = channels == 1 && times == 1;
        const std::int64_t slices = count("slices", isPlain ? images() : 1);
        if (double(slices) * double(channels) * double(times) != double(images())) {
            refuseFile(file_,
                       countText(images(), "image") + " of " + countText(slices, "slice") + ", " +
                           axesText(channels, times),
                       "as many as these make");
        }
        const auto at = [=](auto z, auto c, auto t) { return c + channels * (z + slices * t); };
        return planesOf(file_.string(), slices, channels, times, at, listener);
    }

    void setSpacing(TiffVolume& volume, const Listener& listener) const {
        constexpr int kInch = 2, kCentimetre = 3;
        glm::dvec3 spacing(1);
        const bool isScreen = tiff_.pixelsPerUnit.x == 72 && !lines_.contains("unit");
        for (int axis = 0; axis < 2; ++axis)
            if (tiff_.pixelsPerUnit[axis] > 0 && !isScreen)
                spacing[axis] = 1 / tiff_.pixelsPerUnit[axis];
        const double depth = std::abs(number("spacing").value_or(0));
        if (depth > 0 && std::isfinite(depth)) spacing.z = depth;
        if (lines_.contains("unit")) {
            volume.lengthUnit = lengthUnitNamed(lines_.at("unit"));
            if (!toOneUnit(spacing, volume.lengthUnit)) {
                listener.warn(file_.string() +
                              ": its axes have units of their own, not all of "
                              "which are known; lengths stay as they are");
                volume.lengthUnit.clear();
            }
        } else if (!isScreen && tiff_.pixelsPerUnit.x > 0) {
            volume.lengthUnit = tiff_.resolutionUnit == kInch         ? "in"
                                : tiff_.resolutionUnit == kCentimetre ? "cm"
                                                                      : "";
        }
        if (spacing != glm::dvec3(1) || !volume.lengthUnit.empty()) volume.spacing = spacing;
    }

    // Takes ImageJ's calibration of values if it is linear.
    void setRescale(TiffVolume& volume, const Listener& listener) const {
        constexpr int kStraight = 0, kNone = 20;
        const double said = number("cf").value_or(kStraight);
        const int function = said >= 0 && said < 100 ? int(said) : -1;
        const std::optional<double> c0 = number("c0"), c1 = number("c1");
        if (function == kNone || (function == kStraight && !c0 && !c1)) return;
        const Rescale rescale{c1.value_or(1), c0.value_or(0)};
        const bool isLine = function == kStraight && std::isfinite(rescale.slope) &&
                            std::isfinite(rescale.intercept) && rescale.slope != 0;
        if (isLine) {
            volume.rescale = rescale;
        } else {
            listener.warn(file_.string() +
                          ": values are calibrated by no straight line (ImageJ's cf=" +
                          numberText(said) + "), and read as stored");
        }
    }

  private:
    // @return whether a common unit exists; the unit of x is used, and y and z are converted
    bool toOneUnit(glm::dvec3& spacing, const std::string& unit) const {
        constexpr std::array<const char*, 3> kNames{"unit", "yunit", "zunit"};
        for (std::size_t axis = 1; axis < kNames.size(); ++axis) {
            const auto own = lines_.find(kNames[axis]);
            if (own == lines_.end() || own->second == lines_.at("unit")) continue;
            const double millimetres = millimetresIn(lengthUnitNamed(own->second));
            if (millimetres == 0 || unit.empty()) return false;
            spacing[int(axis)] *= millimetres / millimetresIn(unit);
        }
        return true;
    }

    std::optional<double> number(const char* name) const {
        const auto found = lines_.find(name);
        return found == lines_.end() ? std::nullopt : numberIn<double>(found->second);
    }
    std::int64_t count(const char* name, std::int64_t missing) const {
        const auto found = lines_.find(name);
        if (found == lines_.end()) return missing;
        const auto number = numberIn<std::int64_t>(found->second);
        if (number && *number >= 1 && *number < 0x7fffffff) return *number;
        refuseFile(file_, std::string(name) + "=" + printable(found->second),
                   "a number of images in ImageJ's description");
    }

    const Path& file_;
    const TiffPages& tiff_;
    std::map<std::string, std::string> lines_;
};

// Returns the number of planes after the only page's pixels, its own included.
std::int64_t planesBehind(const TiffPages& tiff) {
    const TiffPage& page = tiff.pages[0];
    if (tiff.pages.size() != 1 || page.pixelBytes == 0) return 1;
    return std::int64_t(page.roomBytes / page.pixelBytes);
}

// Picks a volume's planes after checking that they exist.
class PlaneTaker {
  public:
    PlaneTaker(const Path& file, const TiffPages& tiff, const std::optional<std::int64_t>& chosen)
        : file_(file), tiff_(tiff), chosen_(chosen) {}

    // @param pages  pages that may be planes, unless planes follow the only page
    // @return false, with nothing taken, if the description contradicts the file
    bool take(const Planes& planes, std::int64_t all, const std::string& program,
              const std::vector<std::int64_t>& pages, const Listener& listener,
              TiffVolume& volume) const {
        const auto count = std::int64_t(pages.size());
        const std::int64_t behind = planesBehind(tiff_);
        volume.areBehind = count == 1 && all > 1 && behind > 1;
        if (volume.areBehind ? behind < all : count != all) {
            const std::string got = countText(volume.areBehind ? behind : count, "page");
            const std::string said = countText(all, "image") + ", as " + program + " says";
            // Programs that remove pages leave the description unchanged.
            if (volume.areBehind || planes.volumes > 1) refuseFile(file_, got, said);
            listener.warn(file_.string() + ": has " + got + " and not " + said);
            return false;
        }
        volume.volumes = planes.volumes;
        const std::int64_t n = chooseVolume(file_.string(), planes.axes, planes.volumes, chosen_);
        for (std::int64_t slice = 0; slice < planes.slices; ++slice) {
            const std::int64_t plane = planes.at(slice, n);
            volume.planes.push_back(volume.areBehind ? plane : pages[std::size_t(plane)]);
        }
        return true;
    }

  private:
    const Path& file_;
    const TiffPages& tiff_;
    const std::optional<std::int64_t>& chosen_;
};

// Returns the pages in order, without reduced copies.
std::vector<std::int64_t> wholePages(const Path& file, const TiffPages& tiff,
                                     const Listener& listener) {
    std::vector<std::int64_t> pages;
    for (std::size_t i = 0; i < tiff.pages.size(); ++i)
        if (!tiff.pages[i].isReduced) pages.push_back(std::int64_t(i));
    const std::size_t left = tiff.pages.size() - pages.size();
    if (pages.empty()) {
        for (std::size_t i = 0; i < tiff.pages.size(); ++i) pages.push_back(std::int64_t(i));
    } else if (left > 0) {
        listener.warn(file.string() + ": " + std::to_string(left) + " of " +
                      countText(tiff.pages.size(), "page") +
                      (left == 1 ? " is a thumbnail, smaller copy or mask, and left out"
                                 : " are thumbnails, smaller copies or masks, and left out"));
    }
    return pages;
}

// Parses tifffile's `{"shape": [2, 3, 64, 64]}`.
std::vector<std::int64_t> shapeIn(const std::string& text) {
    std::vector<std::int64_t> shape;
    std::size_t at = text.find('[');
    while (text.starts_with("{\"shape\":") && at < text.size() && text[at] != ']') {
        const std::size_t end = text.find_first_of(",]", at + 1);
        if (end == std::string::npos) return {};
        const std::size_t first = text.find_first_not_of(' ', at + 1);
        const auto number = numberIn<std::int64_t>(text.substr(first, end - first));
        if (!number || *number < 1 || *number > 0x7fffffff) return {};
        shape.push_back(*number);
        at = end;
    }
    return shape;
}

// The shape's last axes belong to a page; slices come before them.
// @return no slices if there is no such description
Planes planesOfShape(const TiffPages& tiff) {
    std::vector<std::int64_t> shape = shapeIn(tiff.description);
    const std::size_t ofPage = tiff.samples > 1 ? 3 : 2;
    const auto imagesOf = [&shape, ofPage] {
        double images = 1;
        for (std::size_t i = 0; i + ofPage < shape.size(); ++i) images *= double(shape[i]);
        return images;
    };
    const auto held = double(std::max(std::int64_t(tiff.pages.size()), planesBehind(tiff)));
    // A trailing axis of one sample is not one of the page's two axes.
    while (shape.size() > ofPage && shape.back() == 1 && imagesOf() > held) shape.pop_back();
    Planes planes;
    planes.slices = 0;
    if (shape.size() <= ofPage) return planes;
    shape.resize(shape.size() - ofPage);
    // Axes of length 1 number nothing.
    std::erase(shape, 1);
    if (shape.empty()) shape.push_back(1);
    planes.slices = shape.back();
    double volumes = 1;
    for (std::size_t i = 0; i + 1 < shape.size(); ++i) {
        planes.axes += (i == 0 ? "axes " : "x") + std::to_string(shape[i]);
        volumes *= double(shape[i]);
    }
    if (volumes * double(planes.slices) > 0x7fffffff) planes.slices = 0;
    planes.volumes = planes.slices > 0 ? std::int64_t(volumes) : 1;
    planes.at = [slices = planes.slices](auto i, auto n) { return n * slices + i; };
    return planes;
}

void takeOme(const Path& file, const TiffPages& tiff, const std::vector<OmePicture>& pictures,
             const std::optional<std::int64_t>& chosen, const Listener& listener,
             TiffVolume& volume) {
    const auto planesIn = [&file](const OmePicture& one, const Listener& heard) {
        const auto at = [&one](auto z, auto c, auto t) {
            return one.pages[std::size_t(z + one.slices * (c + one.channels * t))];
        };
        return planesOf(file.string(), one.slices, one.channels, one.times, at, heard);
    };
    volume.volumes = 0;
    for (const OmePicture& one : pictures) volume.volumes += planesIn(one, {}).volumes;
    const std::string axes = pictures.size() == 1
                                 ? planesIn(pictures[0], {}).axes
                                 : countText(std::int64_t(pictures.size()), "picture");
    std::int64_t n = chooseVolume(file.string(), axes, volume.volumes, chosen);
    std::size_t i = 0;
    for (; n >= planesIn(pictures[i], {}).volumes; ++i) n -= planesIn(pictures[i], {}).volumes;
    const OmePicture& picture = pictures[i];
    const Planes planes = planesIn(picture, listener);
    for (std::int64_t slice = 0; slice < planes.slices; ++slice) {
        const std::int64_t page = planes.at(slice, n);
        if (page >= 0 && page < std::int64_t(tiff.pages.size())) {
            volume.planes.push_back(page);
            continue;
        }
        refuseFile(file,
                   "slice " + std::to_string(slice) +
                       (page < 0 && !picture.otherFile.empty()
                            ? " in another file, " + printable(picture.otherFile)
                            : " of no page (there are " + std::to_string(tiff.pages.size()) + ")"),
                   "all slices of a volume in one file, as OME-XML describes it");
    }
    volume.lengthUnit = picture.lengthUnit;
    glm::dvec3 spacing = picture.spacing;
    if (spacing == glm::dvec3(0)) return;
    const double known = std::max({spacing.x, spacing.y, spacing.z});
    const glm::dvec3 given = spacing;
    for (int axis = 0; axis < 3; ++axis)
        if (spacing[axis] == 0)
            spacing[axis] = axis < 2 && given[1 - axis] > 0 ? given[1 - axis] : known;
    if (given.z == 0 && planes.slices > 1)
        listener.warn(file.string() +
                      ": does not say how far slices are apart (PhysicalSizeZ), and is read as if "
                      "it were as far as pixels");
    volume.spacing = spacing;
}

}  // namespace

TiffVolume findTiffVolume(const Path& file, const TiffPages& tiff, bool isAlone,
                          const std::optional<std::int64_t>& chosen, const Listener& listener) {
    TiffVolume volume;
    const std::string& text = tiff.description;
    if (!isAlone && !text.starts_with("ImageJ=")) {
        volume.planes = wholePages(file, tiff, listener);
        return volume;
    }
    if (text.find("<OME") != std::string::npos || text.find(":OME") != std::string::npos) {
        const std::vector<OmePicture> pictures = readOme(file, text, tiff.samples);
        if (!pictures.empty()) {
            takeOme(file, tiff, pictures, chosen, listener, volume);
            return volume;
        }
    }
    const std::vector<std::int64_t> pages = wholePages(file, tiff, listener);
    const PlaneTaker taker(file, tiff, chosen);
    bool isTaken = false;
    if (text.starts_with("ImageJ=")) {
        const ImageJ imageJ(file, tiff);
        isTaken =
            taker.take(imageJ.planes(listener), imageJ.images(), "ImageJ", pages, listener, volume);
        imageJ.setSpacing(volume, listener);
        volume.isPaletteShown = true;
        imageJ.setRescale(volume, listener);
    } else if (tiff.metaMorphPlanes > 1) {
        Planes planes;
        planes.slices = std::int64_t(tiff.metaMorphPlanes);
        planes.at = [](auto i, auto) { return i; };
        isTaken = taker.take(planes, planes.slices, "MetaMorph", pages, listener, volume);
    } else if (const Planes planes = planesOfShape(tiff); planes.slices > 0) {
        isTaken =
            taker.take(planes, planes.slices * planes.volumes, "tifffile", pages, listener, volume);
    }
    if (!isTaken) {
        chooseVolume(file.string(), "its pages", 1, chosen);
        volume.planes = pages;
    }
    return volume;
}

}  // namespace deltasplat
