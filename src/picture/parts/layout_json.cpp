// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/layout_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "deltasplat/error.h"
#include "files/checked_json.h"

namespace deltasplat {

namespace {

using Json = nlohmann::ordered_json;

// A visitor is called with each member's name, so that one list serves writing and reading.
class Writer {
  public:
    template <typename T>
    void operator()(const char* name, const T& value) {
        json[name] = jsonOf(value);
    }

    Json json = Json::object();

  private:
    // JSON has no infinity, the value of an unknown bound.
    static Json jsonOf(double value) { return std::isfinite(value) ? Json(value) : Json(); }
    static Json jsonOf(int value) { return value; }
    static Json jsonOf(bool value) { return value; }
    static Json jsonOf(PictureFilter value) { return pictureFilterName(value); }
    template <glm::length_t N, typename T>
    static Json jsonOf(const glm::vec<N, T>& value) {
        Json json = Json::array();
        for (glm::length_t i = 0; i < N; ++i) json.push_back(jsonOf(value[i]));
        return json;
    }
    static Json jsonOf(const glm::dmat3& value) {
        return {jsonOf(value[0]), jsonOf(value[1]), jsonOf(value[2])};
    }
    static Json jsonOf(const PlaneBox& box) { return {jsonOf(box.min), jsonOf(box.max)}; }
    template <typename T>
    static Json jsonOf(const std::optional<T>& value) {
        return value ? jsonOf(*value) : Json();
    }
    template <typename T>
    static Json jsonOf(const std::vector<T>& values) {
        Json json = Json::array();
        for (const T& value : values) json.push_back(jsonOf(value));
        return json;
    }
};

class Reader {
  public:
    explicit Reader(const Json& json) : json_(json) {}

    template <typename T>
    void operator()(const char* name, T& value) {
        read(json_.at(name), value);
    }

  private:
    static void read(const Json& json, double& value) {
        value = json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
    }
    static void read(const Json& json, int& value) { value = wholeNumberOf<int>(json); }
    static void read(const Json& json, bool& value) { value = json.get<bool>(); }
    static void read(const Json& json, PictureFilter& value) {
        const auto name = json.get<std::string>();
        for (const PictureFilter filter : {PictureFilter::kCatmullRom, PictureFilter::kMitchell,
                                           PictureFilter::kGauss, PictureFilter::kBox}) {
            value = filter;
            if (pictureFilterName(filter) == name) return;
        }
        throw Error(ErrorCode::kInput, "a filter that there is not");
    }
    template <glm::length_t N, typename T>
    static void read(const Json& json, glm::vec<N, T>& value) {
        for (glm::length_t i = 0; i < N; ++i) read(json.at(std::size_t(i)), value[i]);
    }
    static void read(const Json& json, glm::dmat3& value) {
        for (glm::length_t i = 0; i < 3; ++i) read(json.at(std::size_t(i)), value[i]);
    }
    static void read(const Json& json, PlaneBox& box) {
        read(json.at(0), box.min);
        read(json.at(1), box.max);
    }
    template <typename T>
    static void read(const Json& json, std::optional<T>& value) {
        value.reset();
        if (!json.is_null()) read(json, value.emplace());
    }
    template <typename T>
    static void read(const Json& json, std::vector<T>& values) {
        values.clear();
        for (const Json& element : json) read(element, values.emplace_back());
    }

    const Json& json_;
};

template <typename Visitor, typename CameraT>
void visitCamera(Visitor& visit, CameraT& camera) {
    visit("direction", camera.direction);
    visit("right", camera.right);
    visit("up", camera.up);
    visit("target", camera.targetWorld);
    visit("frame_width", camera.frameWidthWorld);
    visit("target_in_frame", camera.targetInFrame);
    visit("pixel_aspect", camera.pixelAspect);
    visit("target_distance", camera.targetDistanceWorld);
    visit("near", camera.nearWorld);
    visit("size", camera.sizePixels);
    visit("overscan", camera.overscanPixels);
}

template <typename Visitor, typename ViewT>
void visitView(Visitor& visit, ViewT& layout) {
    auto& place = layout.place;
    auto& view = place.view;
    visit("slice_axis", view.sliceAxis);
    visit("front_to_back", view.frontToBack);
    visit("slice_step", view.sliceStepWorld);
    visit("view_resolution", view.resolution);
    visit("pixels_per_voxel", view.pixelsPerVoxel);
    visit("shift_per_slice", view.shiftPerSlice);
    visit("base_from_pixel", view.baseFromPixel);
    visit("eye", view.eye);
    visit("world_from_step", view.worldFromStep);
    visit("slope_step", view.slopeStep);
    visit("slope_limit", view.slopeLimit);
    visit("slope_min", view.slopeMin);
    visit("slope_max", view.slopeMax);
    visit("pixels_per_slope", view.pixelsPerSlope);
    visit("steps", view.steps);
    visit("thin_slices", place.parts.slices);
    visit("thin_within", place.parts.within);
    visit("joined_slices", place.parts.joined);
    visit("joined_slant", place.parts.slants[1]);  // at most two slices are joined
    visit("thin_origin", place.parts.origin);
    visit("first_slice", place.firstSlice);
    visit("first_voxel", place.firstVoxel);
    visit("resolution", place.resolution);
    visit("offset_pixels", place.offsetPixels);
    visit("spacing", place.spacing);
    visit("filter", place.filter);
    visit("color", place.color);
    visit("channels", layout.channels);
    visit("reach", layout.reach);
    visit("slabs", layout.slabs);
    visit("bound_color", layout.bound.color);
    visit("bound_alpha", layout.bound.alpha);
}

void require(bool holds, const char* what) {
    if (!holds) throw Error(ErrorCode::kInput, what);
}

bool isFinite(const glm::dmat3& matrix) {
    for (glm::length_t c = 0; c < 3; ++c)
        for (glm::length_t r = 0; r < 3; ++r)
            if (!std::isfinite(matrix[c][r])) return false;
    return true;
}

// Whether coordinates are far enough from overflow.
bool isSane(const PlaneBox& box) {
    constexpr int kMost = 1 << 30;
    return box.min.x >= -kMost && box.min.y >= -kMost && box.max.x <= kMost && box.max.y <= kMost &&
           box.min.x <= box.max.x && box.min.y <= box.max.y;
}

bool holds(const PlaneBox& all, const PlaneBox& box) {
    return box.empty() || (box.min.x >= all.min.x && box.min.y >= all.min.y &&
                           box.max.x <= all.max.x && box.max.y <= all.max.y);
}

template <glm::length_t N>
bool isFinite(const glm::vec<N, double>& vector) {
    for (glm::length_t i = 0; i < N; ++i)
        if (!std::isfinite(vector[i])) return false;
    return true;
}

void check(const Camera& camera) {
    require(isFinite(camera.direction) && isFinite(camera.right) && isFinite(camera.up) &&
                isFinite(camera.targetWorld) && isFinite(camera.targetInFrame) &&
                std::isfinite(camera.targetDistanceWorld) && std::isfinite(camera.nearWorld),
            "a camera that is nowhere");
    require(camera.frameWidthWorld > 0 && std::isfinite(camera.frameWidthWorld) &&
                camera.pixelAspect > 0 && std::isfinite(camera.pixelAspect),
            "a frame of no size");
    constexpr int kMost = 1 << 20;  // more than any file format has
    for (int axis = 0; axis < 2; ++axis) {
        const int pixels = camera.sizePixels[axis];
        const int overscan = camera.overscanPixels[axis];
        require(pixels >= 1 && pixels <= kMost, "a picture of no size");
        require(overscan >= 0 && overscan < pixels - overscan, "overscan without a picture");
    }
}

// Whether slices can be joined this way.
bool canBeJoined(const Subdivision& parts) {
    const glm::ivec2 slant = glm::abs(parts.slants[1]);
    if (parts.joined == 1) return slant == glm::ivec2(0);
    return parts.joined == 2 && !parts.divides() && std::max(slant.x, slant.y) <= 1;
}

void check(const ViewLayout& layout) {
    const PlanePlace& place = layout.place;
    const Factorization& view = place.view;
    require(view.sliceAxis >= 0 && view.sliceAxis < 3, "an axis that there is not");
    require(layout.channels == (place.color ? 1 : 4), "channels that no layer has");
    require(place.parts.slices >= 1 && place.parts.within >= 1 && place.parts.within <= 2,
            "voxels in parts that there are not");
    require(canBeJoined(place.parts), "slices joined that cannot be");
    const int joined = place.parts.joined;
    const glm::ivec2 slant = place.parts.slants[1];
    // From an eye, joined slices of a region have one slant.
    require(view.slopeStep.has_value() == (joined == 2 && view.eye) &&
                (!view.slopeStep || *view.slopeStep == (view.frontToBack ? -slant : slant)),
            "slopes that are not those of joined slices");
    require(isResolution(place.resolution) && place.spacing > 0 && std::isfinite(place.spacing),
            "a base plane of no pixels");
    require(isFinite(view.baseFromPixel) && isFinite(view.worldFromStep) &&
                view.slopeMin.x <= view.slopeMax.x && view.slopeMin.y <= view.slopeMax.y,
            "a view of nothing");
    require(view.steps > 0 && std::isfinite(view.steps), "slices that no line of sight crosses");
    require(view.sliceStepWorld > 0 && std::isfinite(view.sliceStepWorld), "slices of no depth");
    require(isSane(layout.reach), "slabs that are out of reach");
    for (const PlaneBox& slab : layout.slabs)
        require(isSane(slab) && holds(layout.reach, slab), "slabs that are out of reach");
}

}  // namespace

int PictureLayout::slabs() const {
    std::size_t count = 0;
    for (const ViewLayout& view : views) count += view.slabs.size();
    return int(count);
}

Json layoutJson(const PictureLayout& layout) {
    Writer camera;
    visitCamera(camera, layout.camera);
    camera.json["projection"] = projectionName(layout.camera.projection);
    Json views = Json::array();
    for (const ViewLayout& view : layout.views) {
        Writer writer;
        visitView(writer, view);
        views.push_back(std::move(writer.json));
    }
    return {{"camera", std::move(camera.json)}, {"views", std::move(views)}};
}

namespace {

Projection projectionOf(const std::string& name) {
    for (const Projection projection :
         {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong})
        if (projectionName(projection) == name) return projection;
    throw Error(ErrorCode::kInput, "a projection that there is not");
}

}  // namespace

PictureLayout layoutOf(const Json& json) {
    PictureLayout layout;
    Reader camera(json.at("camera"));
    visitCamera(camera, layout.camera);
    layout.camera.projection = projectionOf(json.at("camera").at("projection").get<std::string>());
    check(layout.camera);
    for (const Json& view : json.at("views")) {
        Reader reader(view);
        ViewLayout& of = layout.views.emplace_back();
        visitView(reader, of);
        check(of);
        of.place.thin = subdivided(of.place.view, of.place.parts);
    }
    return layout;
}

namespace {

using Json = nlohmann::ordered_json;

std::string textOf(const Notes& notes, const std::string& name) {
    const auto found = std::find_if(notes.begin(), notes.end(),
                                    [&](const auto& note) { return note.first == name; });
    return found == notes.end() ? "no " + name : name + " " + found->second;
}

Method methodOf(const std::string& name) {
    for (const Method method :
         {Method::kAuto, Method::kDelta, Method::kSparse, Method::kTraditional})
        if (methodName(method) == name) return method;
    throw Error(ErrorCode::kInput, "a method that there is not");
}

void require(bool holds) {
    if (!holds) throw Error(ErrorCode::kInput, "a part of nothing");
}

}  // namespace

std::string shareText(const SlabShare& share) {
    std::string text = std::to_string(share.first);
    if (share.last != share.first) text += "-" + std::to_string(share.last);
    return text + "/" + std::to_string(share.count);
}

std::string headerText(const PartHeader& header) {
    const Json json = {{"share", {header.share.first, header.share.last, header.share.count}},
                       {"slabs", {header.firstSlab, header.lastSlab}},
                       {"picture", Json(header.notes.picture)},
                       {"part", Json(header.notes.part)},
                       {"method", methodName(header.method)},
                       {"tolerance", {header.tolerance.relative, header.tolerance.value}},
                       {"content", header.content},
                       {"layout", layoutJson(header.layout)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PartHeader headerOf(const std::string& text) {
    const Json json = parseCheckedJson(text, "header", "that of a part");
    PartHeader header;
    const Json &share = json.at("share"), &slabs = json.at("slabs");
    header.share = {share.at(0).get<int>(), share.at(1).get<int>(), share.at(2).get<int>()};
    header.firstSlab = slabs.at(0).get<int>();
    header.lastSlab = slabs.at(1).get<int>();
    header.notes = {json.at("picture").get<Notes>(), json.at("part").get<Notes>()};
    header.method = methodOf(json.at("method").get<std::string>());
    header.tolerance = {json.at("tolerance").at(0).get<double>(),
                        json.at("tolerance").at(1).get<double>()};
    header.content = json.at("content").get<std::string>();
    header.layout = layoutOf(json.at("layout"));
    require(header.share.first >= 1 && header.share.first <= header.share.last &&
            header.share.last <= header.share.count && header.share.count <= kMostSlabShares);
    require(header.firstSlab >= 0 && header.firstSlab <= header.lastSlab &&
            header.lastSlab <= header.layout.slabs());
    return header;
}

HeaderDifference differenceOf(const PartHeader& part, const PartHeader& first) {
    // Options first, because other differences follow from them.
    for (const auto* notes : {&first.notes.picture, &part.notes.picture}) {
        for (const auto& [name, text] : *notes) {
            const std::string got = textOf(part.notes.picture, name);
            const std::string expected = textOf(first.notes.picture, name);
            if (got != expected) return {got, expected};
        }
    }
    if (part.share.count != first.share.count)
        return {"part " + shareText(part.share), "one of " + std::to_string(first.share.count)};
    const Json got = layoutJson(part.layout), expected = layoutJson(first.layout);
    if (got.at("camera") != expected.at("camera"))
        return {"a picture of another camera or size", "the same"};
    if (part.content != first.content || got != expected)
        return {"a picture of other voxels or colours", "the same"};
    return {};
}

}  // namespace deltasplat
