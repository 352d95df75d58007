// SPDX-License-Identifier: Apache-2.0
// The same pixels on every processor: hashes of float pictures, of cameras and of sample volumes,
// against the list in hashes.txt, which scripts/update_golden.sh writes.
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>

#include "deltasplat/simd.h"
#include "deltasplat/synth/analytic_volume.h"
#include "deltasplat/threads.h"
#include "golden/golden_scenes.h"
#include "golden/golden_volumes.h"
#include "support/odd_floats.h"
#include "support/simd_levels.h"
#include "support/small_joined.h"
#include "synth/noise.h"

namespace deltasplat::test {
namespace {

class Hash {
  public:
    template <typename Number>
    void add(Number value) {
        using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
        state_ = mixBits(state_ ^ std::bit_cast<Bits>(value)) + 1;
    }
    std::string text() const {
        std::ostringstream text;
        text << std::hex << state_;
        return text.str();
    }

  private:
    std::uint64_t state_ = 0;
};

using Hashes = std::map<std::string, std::string>;

Hashes ofScenes() {
    const std::map<std::string, Volume> volumes = goldenVolumes();
    Hashes hashes;
    for (const GoldenScene& scene : goldenScenes()) {
        RenderOptions options = scene.options;
        for (MediumPart& part : options.optics.parts)
            part.volume = std::make_shared<const Volume>(volumes.at(scene.part));
        std::optional<SmallJoined> joined;
        if (scene.joined > 1) joined.emplace();
        const RenderResult result = render(volumes.at(scene.volume), options);
        EXPECT_EQ(result.stats.joined, scene.joined) << scene.name;
        if (scene.joined > 1) {
            EXPECT_EQ(result.stats.resolution, 1.0 / scene.joinedWithin) << scene.name;
        }
        Hash hash;
        for (const glm::dvec3& axis : {result.camera.right, result.camera.up}) {
            for (int i = 0; i < 3; ++i) hash.add(axis[i]);
        }
        for (const float value : result.image.rgba) hash.add(value);
        hashes["picture " + scene.name] = hash.text();
    }
    return hashes;
}

Hashes ofSamples() {
    Hashes hashes;
    for (const std::string& name : analyticNames()) {
        const AnalyticVolume volume = makeAnalytic(name, 3, name == "engine" ? 0.1 : 0.0);
        Hash hash;
        for (int i = 0; i < 20000; ++i) {
            const auto part = [&](int axis) {
                return 2 * unitFromBits(mixBits(std::uint64_t(3 * i + axis))) - 1;
            };
            const glm::dvec3 p(part(0), part(1), part(2));
            hash.add(volume.valueAt(p));
            for (const AnalyticGrid& other : volume.others) hash.add(other.valueAt(p));
            const glm::dvec3 color = volume.colorAt ? volume.colorAt(p) : glm::dvec3(0);
            for (int axis = 0; volume.colorAt && axis < 3; ++axis) hash.add(color[axis]);
        }
        hashes["sample " + name] = hash.text();
    }
    return hashes;
}

const char* const kList = DELTASPLAT_SOURCE_DIR "/tests/golden/hashes.txt";

// Each line: the hash, a space, the name.
Hashes listed() {
    std::ifstream in(kList);
    Hashes hashes;
    std::string hash, name;
    while (in >> hash && std::getline(in >> std::ws, name)) hashes[name] = hash;
    return hashes;
}

// A message for each name whose hash differs, so that all can be seen at once.
std::string differences(const Hashes& got, const std::string& prefix) {
    const Hashes known = listed();
    std::string text;
    for (const auto& [name, hash] : known) {
        if (name.rfind(prefix, 0) == 0 && got.count(name) == 0) text += name + ": missing\n";
    }
    for (const auto& [name, hash] : got) {
        const auto place = known.find(name);
        if (place == known.end() || place->second != hash) text += name + ": " + hash + "\n";
    }
    return text;
}

TEST(Golden, HasFortyScenesAndMoreAllOfThemDifferent) {
    Hashes nameOf;
    for (const auto& [name, hash] : listed()) {
        EXPECT_EQ(nameOf.count(hash), 0u) << name << " is the same as " << nameOf[hash];
        nameOf[hash] = name;
    }
    EXPECT_GE(goldenScenes().size(), 40u);
}

TEST(Golden, WritesTheListWhenAsked) {
    if (std::getenv("DELTASPLAT_GOLDEN_UPDATE") == nullptr) {
        GTEST_SKIP() << "DELTASPLAT_GOLDEN_UPDATE is not set";
    }
    std::ofstream out(kList);
    for (const Hashes& hashes : {ofScenes(), ofSamples()}) {
        for (const auto& [name, hash] : hashes) out << hash << ' ' << name << '\n';
    }
    ASSERT_TRUE(out.flush());
}

TEST(Golden, SampleVolumesAreThoseOfTheList) {
    EXPECT_EQ(differences(ofSamples(), "sample"), "");
}

TEST(Golden, PicturesAreThoseOfTheListAtEverySimdLevel) {
    for (const std::string& level : test::testedSimdLevels()) {
        setSimdLevel(level);
        EXPECT_EQ(differences(ofScenes(), "picture"), "") << level;
    }
    setSimdLevel("auto");
}

// Worker threads take on what the thread that started them had.
TEST(Golden, PicturesDoNotDependOnTheCallersFloatEnvironment) {
    for (const OddFloats::Kind kind : OddFloats::kinds()) {
        const OddFloats odd(kind);
        const ThreadLimit threads(3);
        EXPECT_EQ(differences(ofScenes(), "picture"), "") << OddFloats::name(kind);
        EXPECT_TRUE(odd.stillSet()) << OddFloats::name(kind);
    }
}

}  // namespace
}  // namespace deltasplat::test
