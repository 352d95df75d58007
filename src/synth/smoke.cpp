// SPDX-License-Identifier: Apache-2.0
// Designs of this project with noise.cpp; a seed determines all places. Explosion: lumpy balls
// around a ball, hot where they meet. Fire: tongues of flame and puffs of smoke, displaced by
// noise.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "base/portable_math.h"
#include "synth/noise.h"
#include "synth/volumes.h"

namespace deltasplat {

ValueAt makeCloud(std::uint64_t seed) {
    return [seed](const glm::dvec3& p) {
        // Bulges grow out of a flattened ball; density rises with the depth below their surface.
        constexpr glm::dvec3 kHalfAxes(0.92, 0.7, 0.85);
        constexpr double kCore = 0.42;      // share of the radius left at the deepest crease
        constexpr double kFrequency = 2.2;  // lattice cells per unit, largest octave
        constexpr double kSkin = 0.55;      // depth of full density, as a share of the radius
        const glm::dvec3 q = p / kHalfAxes;
        const double radius = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
        if (radius >= 1) return 0.0;
        const double depth = kCore + (1 - kCore) * billowAt(seed, p * kFrequency) - radius;
        return std::clamp(depth / kSkin, 0.0, 1.0);
    };
}

namespace {

constexpr double kReach = 0.98;  // distance from the centre beyond which all is empty

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
        // Less smoke in cracks shows the heat inside.
        const double depth = place.depth - 0.02 * place.crack;
        return std::clamp(depth / kSkin, 0.0, 1.0);
    }

    double temperatureAt(const glm::dvec3& p) const {
        constexpr double kAir = 300, kHottest = 2200;  // kelvin
        constexpr double kHot = 0.78;                  // distance from the centre where heat begins
        const double radius = glm::length(p);
        if (radius >= kHot) return kAir;
        const Place place = placeOf(p);
        const double core = 1 - smoothStep(0.35, kHot, radius);
        const double crack = place.crack * (1 - smoothStep(0.54, 0.74, radius));
        const double share = std::max(core * core, crack) * smoothStep(-0.05, 0.03, place.depth);
        return kAir + (kHottest - kAir) * share;
    }

    // Bulges are ash-coloured, creases scorched.
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
        double crack;  // share of a crack, 0..1
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
    constexpr double kWarm = 500;  // kelvin; colder gas does not glow
    const auto ball = std::make_shared<const Explosion>(seed);
    AnalyticVolume volume{"explosion", [ball](const glm::dvec3& p) { return ball->smokeAt(p); }};
    volume.others.push_back(
        {"temperature", [ball](const glm::dvec3& p) { return ball->temperatureAt(p); }, kWarm});
    volume.colorAt = [ball](const glm::dvec3& p) { return ball->colorAt(p); };
    return volume;
}

namespace {

constexpr double kGround = -0.93;  // y where the fire stands; heights are above it
constexpr double kCold = -1.2;     // excess far from the flame

// Aspects that have separate seeds.
enum Part : std::uint64_t { kTongues, kDrift, kLicks, kPuffs, kSwirl, kBulges };

std::uint64_t seedOf(std::uint64_t seed, Part part) {
    return hash3(seed, part, 0, 0);
}

// Returns the angle of one of many points spread nearly evenly around the axis.
double angleOf(int index, double random) {
    constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt(5))
    return kGoldenAngle * index + 0.8 * random;
}

double distanceToAxis(const glm::dvec3& p, double x, double z) {
    return std::sqrt((p.x - x) * (p.x - x) + (p.z - z) * (p.z - z));
}

class Flame {
  public:
    explicit Flame(std::uint64_t seed)
        : drift_(seedOf(seed, kDrift)), licks_(seedOf(seed, kLicks)) {
        UnitSequence random(seedOf(seed, kTongues));
        addRooted(random);
        addDetached(random);
    }

    // Returns the depth inside the flame: 0 at its surface, 1 deep inside, down to kCold outside.
    double excessAt(const glm::dvec3& p) const {
        const double height = p.y - kGround;
        const double reach = 0.7 - 0.2 * std::clamp(height, 0.0, 1.0);
        const double room =
            std::min({height + 0.06, 1.7 - height, reach - distanceToAxis(p, 0, 0)});
        if (room <= 0) return kCold;

        // Turbulence grows with height.
        const double carry = 0.04 + 0.13 * std::clamp(height, 0.0, 1.2);
        const glm::dvec3 drift = turbulenceAt(drift_, p * glm::dvec3(2.6, 1.9, 2.6), 3);
        const glm::dvec3 q = p + carry * drift * glm::dvec3(1, 0.6, 1);
        const double from = q.y - kGround;
        // Licks are longer than wide, and erode tips more than roots.
        const double licks = fractalAt(licks_, q * glm::dvec3(7, 3, 7), 4);
        double excess = tonguesAt(q) + licks * (0.2 + 0.95 * std::clamp(from / 1.1, 0.0, 1.0));
        excess = std::min(excess - 0.7 * (1 - smoothStep(0, 0.2, from)), from / 0.06);
        return std::max(kCold, std::min(excess, 12 * room + kCold));
    }

  private:
    // A drop shape from `base` on that tapers upwards.
    struct Tongue {
        double x, z, base, height, width;
    };

    void addRooted(UnitSequence& random) {
        constexpr int kCount = 16;
        for (int i = 0; i < kCount; ++i) {
            const double angle = angleOf(i, random.next());
            const double share = std::sqrt((i + 0.3 * random.next()) / kCount);  // of the hearth
            const double height = 1.25 * (1 - 0.7 * share) * (0.85 + 0.3 * random.next());
            const double width = (0.19 - 0.06 * share) * (0.8 + 0.4 * random.next());
            add(angle, 0.4 * share, {0, 0, -0.05, height + 0.12, width});
        }
    }

    void addDetached(UnitSequence& random) {
        constexpr int kCount = 5;
        for (int i = 0; i < kCount; ++i) {
            const double angle = 2 * std::numbers::pi * random.next();
            const double radius = 0.2 * random.next();
            const double base = 0.6 + 0.5 * random.next();
            const double height = 0.25 + 0.2 * random.next();
            add(angle, radius, {0, 0, base, height, 0.05 + 0.04 * random.next()});
        }
    }

    void add(double angle, double radius, Tongue tongue) {
        tongue.x = radius * portable::cos(angle);
        tongue.z = radius * portable::sin(angle);
        tongues_.push_back(tongue);
    }

    double tonguesAt(const glm::dvec3& p) const {
        constexpr double kDepth = 0.13;  // depth below the surface where the excess is 1
        const double height = p.y - kGround;
        // Inflowing air bends all tongues towards the axis.
        const double inwards = 1 - 0.45 * std::clamp(height / 0.8, 0.0, 1.0);
        double excess = -4;
        for (const Tongue& tongue : tongues_) {
            const double away = distanceToAxis(p, inwards * tongue.x, inwards * tongue.z);
            const double depth = radiusAt(tongue, height) - away;
            excess = smoothMax(excess, depth / kDepth, 0.5);
        }
        return excess;
    }

    // Negative below and above a tongue, decreasing with distance.
    static double radiusAt(const Tongue& tongue, double height) {
        const double above = height - tongue.base;
        const double u = above / tongue.height;
        if (u < 0) return 0.55 * tongue.width + 2 * above;
        if (u > 1) return -0.35 * (above - tongue.height);
        return tongue.width * (1 - u) * (0.55 + 2.6 * u * (1 - u));
    }

    std::uint64_t drift_, licks_;
    std::vector<Tongue> tongues_;
};

class Smoke {
  public:
    explicit Smoke(std::uint64_t seed)
        : swirl_(seedOf(seed, kSwirl)), bulges_(seedOf(seed, kBulges)) {
        constexpr int kCount = 22;
        UnitSequence random(seedOf(seed, kPuffs));
        for (int i = 0; i < kCount; ++i) {
            const double share = (i + 0.5 * random.next()) / (kCount - 0.5);  // of the way up
            const double angle = 2 * std::numbers::pi * random.next();
            const double away = (0.03 + 0.22 * share) * std::sqrt(random.next());
            const double radius = (0.11 + 0.17 * share) * (0.8 + 0.4 * random.next());
            glm::dvec3 centre(away * portable::cos(angle), kGround + 0.68 + 0.84 * share,
                              away * portable::sin(angle));
            centre.x += leanAt(centre);
            puffs_.push_back({centre, radius});
        }
    }

    // Returns the share of smoke, in threads, that is as warm as at the centre, 0..1.
    double coreAt(const glm::dvec3& p) const {
        const double share = bodyAt(p) * (1 - smoothStep(0, 0.5, distanceToAxis(p, leanAt(p), 0)));
        if (share == 0) return 0;
        const double threads = fractalAt(swirl_, p * glm::dvec3(5, 3, 5), 3);
        return share * std::clamp(0.8 + 0.8 * threads, 0.0, 1.0);
    }

    // Returns the amount of smoke, 0..1, before flames consume it.
    double bodyAt(const glm::dvec3& p) const {
        const double height = p.y - kGround;
        const double reach = 0.15 + 0.4 * height - distanceToAxis(p, leanAt(p), 0);
        const double wall = 0.98 - std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const double room = std::min({height - 0.4, reach, wall});
        if (room <= 0) return 0;

        const glm::dvec3 q = p + 0.07 * turbulenceAt(swirl_, 2.4 * p, 2);
        const double skin = 0.15 + 0.1 * std::clamp(height, 0.0, 2.0);
        double depth = -1;
        for (const Puff& puff : puffs_) {
            const double inside = puff.radius - glm::distance(q, puff.centre);
            depth = smoothMax(depth, inside / skin, 0.25);
        }
        if (depth <= -0.5) return 0;  // beyond any bulge
        depth += 0.75 * billowAt(bulges_, 4.2 * q) - 0.25;
        return std::clamp(std::min(depth / 0.45, 8 * room), 0.0, 1.0);
    }

  private:
    // Wind blows along x.
    static double leanAt(const glm::dvec3& p) { return 0.06 * (p.y - kGround) * (p.y - kGround); }

    struct Puff {
        glm::dvec3 centre;
        double radius;
    };

    std::uint64_t swirl_, bulges_;
    std::vector<Puff> puffs_;
};

struct Fire {
    explicit Fire(std::uint64_t seed) : flame(seed), smoke(seed) {}

    double flameAt(const glm::dvec3& p) const {
        return std::clamp(flame.excessAt(p) / 0.7, 0.0, 1.0);
    }

    // Smoke forms where flames end, and thins as it rises.
    double smokeAt(const glm::dvec3& p) const {
        const double body = smoke.bodyAt(p);
        if (body == 0) return 0;
        const double height = p.y - kGround;
        const double made = 0.1 + 0.9 * smoothStep(0.5, 1.1, height);
        const double left = 1 - 0.45 * smoothStep(1.0, 1.8, height);
        return body * made * left * (1 - std::min(1.0, 2 * flameAt(p)));
    }

    // A flame's surface is 0.45 of the way from air temperature to the hottest, less further up.
    // Around it and in the smoke above it is cooler.
    double temperatureAt(const glm::dvec3& p) const {
        const double height = p.y - kGround;
        const double excess = flame.excessAt(p);
        const double warmth = std::max(0.0, 1 - excess / kCold);
        const double ofFlame =
            excess > 0 ? 0.45 + 0.55 * smoothStep(0, 1.3, excess) : 0.45 * warmth * warmth;
        const double cooled = 1 - 0.24 * std::clamp(height, 0.0, 1.7);
        const double rising = 0.34 * (1 - smoothStep(0.8, 1.7, height));
        double share = cooled * ofFlame;
        if (rising > share) share = std::max(share, rising * smoke.coreAt(p));
        return kAir + (kHottest - kAir) * share;
    }

    static constexpr double kAir = 300, kHottest = 2200;  // kelvin

    Flame flame;
    Smoke smoke;
};

}  // namespace

AnalyticVolume makeFire(std::uint64_t seed) {
    constexpr double kWarm = 500;  // kelvin; colder gas looks and moves like air
    const auto fire = std::make_shared<const Fire>(seed);
    AnalyticVolume volume{"fire", [fire](const glm::dvec3& p) { return fire->smokeAt(p); }};
    volume.others.push_back(
        {"temperature", [fire](const glm::dvec3& p) { return fire->temperatureAt(p); }, kWarm});
    volume.others.push_back({"flame", [fire](const glm::dvec3& p) { return fire->flameAt(p); }});
    return volume;
}

}  // namespace deltasplat
