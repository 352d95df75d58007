// SPDX-License-Identifier: Apache-2.0
#include "lighting/light_depths.h"

#include <algorithm>
#include <array>
#include <deque>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <utility>
#include <variant>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/threads.h"
#include "deltasplat/view/factorization.h"
#include "lighting/light_sweep.h"
#include "lighting/point_sweep.h"
#include "optics/voxel_units.h"

namespace deltasplat {

namespace {

// What is to be done for several lights, in pieces for threads.
class Sweeps {
  public:
    // @param most  beyond which nothing of light is left
    Sweeps(const LitBlocks& blocks, const Volume& volume, const std::vector<float>& extinctions,
           float most)
        : blocks_(blocks), volume_(volume), extinctions_(extinctions), most_(most) {}

    void add(const Light& light, const glm::dvec3& placeIndex);
    // @param depths  of the lights in the order in which they came, [lights][voxels]
    void run(std::uint16_t* depths) const;

  private:
    using Sweep = std::variant<LightSweep, PointSweep>;
    struct Piece {
        std::size_t sweep;
        std::int64_t first;
        std::int64_t last;
    };

    const LitBlocks::Along& along(int sliceAxis);
    void addPoint(const glm::dvec3& placeIndex);
    std::vector<Piece> pieces() const;

    const LitBlocks& blocks_;
    const Volume& volume_;
    const std::vector<float>& extinctions_;
    float most_;
    std::array<std::optional<LitBlocks::Along>, 3> along_;
    std::deque<LitBlocks::Along> apart_;  // of what lies far apart
    std::vector<Sweep> sweeps_;
    std::vector<std::size_t> lights_;  // of sweeps
    std::size_t lightCount_ = 0;
};

const LitBlocks::Along& Sweeps::along(int sliceAxis) {
    auto& along = along_[std::size_t(sliceAxis)];
    if (!along) along.emplace(blocks_.along(sliceAxis));
    return *along;
}

void Sweeps::add(const Light& light, const glm::dvec3& placeIndex) {
    if (light.positionWorld) {
        addPoint(placeIndex);
    } else {
        const LightWay way(volume_.worldFromIndex, light.direction);
        const auto sweepOf = [&](const LitBlocks::Along& blocks) {
            return LightSweep(blocks, way, volume_.box.min[way.sliceAxis],
                              MetClasses{extinctions_.data(), float(way.sliceWorld), most_});
        };
        const LightSweep all = sweepOf(along(way.sliceAxis));
        constexpr double kLargePlane = 1 << 24;  // bytes
        if (all.bytes(0, all.rows()) <= kLargePlane) {
            sweeps_.emplace_back(all);
        } else {
            for (LitBlocks::Along& part : all.apart())
                sweeps_.emplace_back(sweepOf(apart_.emplace_back(std::move(part))));
        }
    }
    lights_.resize(sweeps_.size(), lightCount_++);
}

// From very far away, light travels one way wherever exactly it starts, and places would be too
// large to tell voxels apart.
void Sweeps::addPoint(const glm::dvec3& placeIndex) {
    constexpr double kFarthest = 1e9;
    const glm::dvec3 middle = 0.5 * (glm::dvec3(volume_.box.min) + glm::dvec3(volume_.box.max));
    const glm::dvec3 away = placeIndex - middle;
    const glm::dvec3 parts = glm::abs(away);
    const double farthest = std::max({parts.x, parts.y, parts.z});
    const glm::dvec3 place =
        farthest > kFarthest ? middle + kFarthest / farthest * away : placeIndex;
    const glm::dmat3 world(volume_.worldFromIndex);
    for (int axis = 0; axis < 3; ++axis) {
        const double slice = planeDistance(volume_.worldFromIndex, axis);
        const glm::ivec3 order = sliceOrder(axis);
        const PointPlace light{
            {place[order.x], place[order.y], place[order.z]},
            glm::dmat3(world[order.x] / slice, world[order.y] / slice, world[order.z] / slice)};
        for (const bool forward : {true, false})
            sweeps_.emplace_back(PointSweep(along(axis), light, forward,
                                            MetClasses{extinctions_.data(), float(slice), most_}));
    }
}

// Enough pieces for every thread to have some work, but none so narrow that rows at its edges,
// which belong to two, take much of it. What a plane needs of a narrow one may be much less.
std::vector<Sweeps::Piece> Sweeps::pieces() const {
    constexpr std::size_t kPiecesPerThread = 4;
    constexpr std::int64_t kLeastRows = 16;
    constexpr double kLargePlane = 1 << 26;  // bytes
    constexpr double kMostStrips = 1024;
    const auto threads = std::size_t(threadCount());
    const auto wanted =
        threads == 1 ? 1 : (kPiecesPerThread * threads + lightCount_ - 1) / lightCount_;
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < sweeps_.size(); ++i) {
        const auto rows = std::visit([](const auto& sweep) { return sweep.rows(); }, sweeps_[i]);
        if (rows == 0) continue;
        const double large =
            std::visit([&](const auto& sweep) { return sweep.bytes(0, rows); }, sweeps_[i]) /
            kLargePlane;
        const auto most = std::max<std::int64_t>(1, rows / kLeastRows);
        const auto strips = std::int64_t(
            std::clamp(std::max(double(wanted), std::min(large, kMostStrips)), 1.0, double(most)));
        const auto edge = [&](std::int64_t n) { return rows * n / strips; };
        for (std::int64_t n = 0; n < strips; ++n) pieces.push_back({i, edge(n), edge(n + 1)});
    }
    return pieces;
}

void Sweeps::run(std::uint16_t* depths) const {
    const std::vector<Piece> all = pieces();
    std::vector<double> bytes(all.size() + 1);
    parallelFor(all.size(), [&](std::size_t i) {
        const Piece& piece = all[i];
        bytes[i] = std::visit([&](const auto& s) { return s.bytes(piece.first, piece.last); },
                              sweeps_[piece.sweep]);
    });
    // Each thread has a piece in hand.
    requireMemory("a plane that light is swept through",
                  *std::max_element(bytes.begin(), bytes.end()) *
                      std::min<double>(threadCount(), double(all.size())));
    parallelFor(all.size(), [&](std::size_t i) {
        const Piece& piece = all[i];
        std::uint16_t* out = depths + 512 * blocks_.size() * lights_[piece.sweep];
        std::visit([&](const auto& s) { s.run(piece.first, piece.last, out); },
                   sweeps_[piece.sweep]);
    });
}

// In a world unit, [classes].
std::vector<float> extinctionsOf(const ClassTable& classes) {
    constexpr double kMost = 1e30;
    std::vector<float> extinctions;
    for (const double depth : depthsOf(classes, 1))
        extinctions.push_back(float(std::min(depth, kMost)));
    return extinctions;
}

}  // namespace

LightDepths::LightDepths(const Volume& volume, const ClassTable& classes,
                         const std::vector<Light>& lights, int octaves)
    : blocks_(volume, classes) {
    const std::size_t voxels = 512 * blocks_.size();
    requireMemory("light on its way to voxels",
                  double(sizeof(std::uint16_t)) * double(voxels) * double(lights.size()));
    depths_ =
        UnclearedArray<std::uint16_t>(voxels * lights.size(), *std::pmr::get_default_resource());
    reaches_.resize(lights.size());
    if (voxels == 0 || lights.empty()) return;
    // What a voxel of a wall leaves of the octave that is dimmed least. More of it would only make
    // its shadow wider, as it is shared between points of a plane.
    constexpr float kMost = 10;
    const float most = std::min(kMost * float(1 << octaves), 1000.0f);
    const std::vector<float> extinctions = extinctionsOf(classes);
    Sweeps sweeps(blocks_, volume, extinctions, most);
    const glm::dmat3 world(volume.worldFromIndex);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const glm::dvec3 placeIndex =
            glm::inverse(world) *
            (light.positionWorld.value_or(glm::dvec3(0)) - glm::dvec3(volume.worldFromIndex[3]));
        if (light.positionWorld) reaches_[i] = blocks_.reachFrom(placeIndex, world);
        sweeps.add(light, placeIndex);
    }
    sweeps.run(&depths_[0]);
}

}  // namespace deltasplat
