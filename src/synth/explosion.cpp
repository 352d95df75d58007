// SPDX-License-Identifier: Apache-2.0
// A design of this project: balls all around a ball, of which noise makes lumps (see
// gradient_noise.cpp); it is hot where they meet.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "portable_math.h"
#include "synth/gradient_noise.h"
#include "synth/hash.h"
#include "synth/shaping.h"
#include "synth/volumes.h"

namespace deltasplat {
namespace {

constexpr double kReach = 0.98;  // distance from the middle at which there is nothing any more

class Explosion {
  public:
    explicit Explosion(std::uint64_t seed)
        : swirl_(hash3(seed, 1, 0, 0)), bulges_(hash3(seed, 2, 0, 0)), soot_(hash3(seed, 3, 0, 0)) {
        constexpr int kCount = 44;
        constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt(5))
        UnitSequence random(hash3(seed, 0, 0, 0));
        for (int i = 0; i < kCount; ++i) {
            const double y = 1 - 2 * (i + 0.2 + 0.6 * random.next()) / kCount;
            const double angle = kGoldenAngle * i + 0.9 * random.next();
            const double size = random.next();
            const double radius = 0.15 + 0.22 * size * size;
            const double away = 0.63 - radius + 0.14 * random.next();
            const double ring = away * std::sqrt(1 - y * y);
            lumps_.push_back(
                {{ring * portable::cos(angle), away * y, ring * portable::sin(angle)}, radius});
        }
    }

    double smokeAt(const glm::dvec3& p) const {
        if (glm::length(p) >= kReach) return 0;
        constexpr double kSkin = 0.05;  // depth of full density
        const Place place = placeOf(p);
        // What is hot in a crack should be seen.
        const double depth = place.depth - 0.02 * place.crack;
        return std::clamp(depth / kSkin, 0.0, 1.0);
    }

    double temperatureAt(const glm::dvec3& p) const {
        constexpr double kAir = 300, kHottest = 2200;  // kelvin
        constexpr double kHot = 0.78;                  // distance from the middle where that begins
        const double radius = glm::length(p);
        if (radius >= kHot) return kAir;
        const Place place = placeOf(p);
        const double core = 1 - smoothStep(0.35, kHot, radius);
        const double crack = place.crack * (1 - smoothStep(0.54, 0.74, radius));
        const double share = std::max(core * core, crack) * smoothStep(-0.05, 0.03, place.depth);
        return kAir + (kHottest - kAir) * share;
    }

    // Bulges are ash, creases are scorched.
    glm::dvec3 colorAt(const glm::dvec3& p) const {
        constexpr glm::dvec3 kScorched(0.085, 0.045, 0.024), kAsh(0.36, 0.335, 0.31);
        const Place place = placeOf(p);
        const double soot = fractalAt(soot_, 3.0 * p, 3);
        const double ash = 0.55 * smoothStep(0.45, 0.85, glm::length(p)) +
                           0.5 * smoothStep(0.1, 0.6, place.bulge) + 0.45 * soot;
        return glm::mix(kScorched, kAsh, std::clamp(ash, 0.0, 1.0) * (1 - 0.8 * place.crack));
    }

  private:
    struct Lump {
        glm::dvec3 centre;
        double radius;
    };

    struct Place {
        double depth;  // below the surface, in units of the cube
        double crack;  // how much of a crack it is, 0..1
        double bulge;  // as billowAt
    };

    Place placeOf(const glm::dvec3& p) const {
        const glm::dvec3 q = p + 0.05 * turbulenceAt(swirl_, 3.0 * p, 2);
        double nearest = -2, second = -2;
        for (const Lump& lump : lumps_) {
            const double depth = lump.radius - glm::distance(q, lump.centre);
            second = std::max(second, std::min(depth, nearest));
            nearest = std::max(nearest, depth);
        }
        const double body = std::max(nearest, 0.5 - glm::length(q));
        const double bulge = billowAt(bulges_, 4.5 * q);
        const double crack =
            std::max(1 - smoothStep(0, 0.05, nearest - second), 1 - smoothStep(0.03, 0.16, bulge));
        const double depth = body + 0.16 * bulge - 0.04;
        return {std::min(depth, kReach - glm::length(p)), crack, bulge};
    }

    std::uint64_t swirl_, bulges_, soot_;
    std::vector<Lump> lumps_;
};

}  // namespace

AnalyticVolume makeExplosion(std::uint64_t seed) {
    constexpr double kWarm = 500;  // kelvin; what is no warmer does not glow
    const auto ball = std::make_shared<const Explosion>(seed);
    AnalyticVolume volume{"explosion", [ball](const glm::dvec3& p) { return ball->smokeAt(p); }};
    volume.others.push_back(
        {"temperature", [ball](const glm::dvec3& p) { return ball->temperatureAt(p); }, kWarm});
    volume.colorAt = [ball](const glm::dvec3& p) { return ball->colorAt(p); };
    return volume;
}

}  // namespace deltasplat
