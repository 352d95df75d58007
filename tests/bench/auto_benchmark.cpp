// SPDX-License-Identifier: Apache-2.0
// How much longer `auto` takes than the quickest of the methods that it may choose from: volumes,
// views, sizes and threads, methods taking turns in rounds of one picture each. Prints a line for
// each setting: milliseconds of `sparse`, `delta` and `auto`, least of all rounds, which of the two
// `auto` chose (`mixed`: one for some slabs, the other for others; `same`: both stamp as much), and
// what it loses, in percent: by the clock, and by its choice alone. Where it chose one method for
// all slabs it goes through that one's very steps, on words of its own; the lesser time of both
// then tells what another choice would have saved. At the end, how both are spread. All is prepared
// anew in each of three orders, for what is prepared first may lie better in memory: pictures of a
// millisecond or two differ by a fifth for that alone. A third of the rounds more are made where
// `auto` seems to lose more than 5 %, lest it be chance. `traditional`, which `auto` never is, is
// left out.
//   auto_benchmark ROUNDS TRANSFER_FUNCTION.json FILE...
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"

namespace {

using namespace deltasplat;

constexpr std::array<Method, 3> kMethods = {Method::kSparse, Method::kDelta, Method::kAuto};
constexpr glm::ivec2 kSizes[] = {{256, 256}, {512, 512}, {1920, 1080}, {3840, 2160}};
const char* const kViews[] = {"front", "back", "left", "right", "top", "bottom", "iso"};

// What a volume is rendered from by each method, prepared one after the other from `first` on.
struct Scenes {
    Scenes(const std::shared_ptr<const Volume>& volume, const RenderOptions& options,
           std::size_t first)
        : first(first) {
        for (std::size_t i = 0; i < kMethods.size(); ++i) {
            const std::size_t m = methodAt(i);
            SplatOptions ofMethod = options.splat;
            ofMethod.method = kMethods[m];
            of[m] = std::make_unique<PreparedScene>(Scene{volume, options.optics}, ofMethod);
        }
    }
    std::size_t methodAt(std::size_t i) const { return (first + i) % kMethods.size(); }

    std::size_t first;
    std::array<std::unique_ptr<PreparedScene>, 3> of;
};

struct Setting {
    int threads;
    const char* view;
    glm::ivec2 size;
    std::array<double, 3> least{1e300, 1e300, 1e300};  // seconds, as kMethods
    std::array<std::uint64_t, 3> stamps{};             // likewise

    // Which method `auto` is in all slabs, or "mixed"; "same" where both have the same stamps.
    const char* choice() const {
        if (stamps[0] == stamps[1]) return "same";
        if (stamps[2] == stamps[0]) return "sparse";
        return stamps[2] == stamps[1] ? "delta" : "mixed";
    }
    // What it loses by the clock.
    double measuredLoss() const { return least[2] / std::min(least[0], least[1]) - 1; }
    // What its choice loses: the method that it is takes no longer than `auto` itself.
    double loss() const {
        double chosen = least[2];
        for (const std::size_t m : {0, 1})
            if (stamps[2] == stamps[m]) chosen = std::min(chosen, least[m]);
        return std::max(0.0, chosen / std::min(least[0], least[1]) - 1);
    }
};

// Adds rounds to the least times of each method.
void addRounds(Scenes& scenes, const Camera& camera, int rounds, Setting& setting) {
    Image image(camera.sizePixels);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < kMethods.size(); ++i) {
            const std::size_t m = scenes.methodAt(i);
            const Clock::time_point start = Clock::now();
            const RenderStats stats = scenes.of[m]->render(camera, image);
            setting.least[m] = std::min(setting.least[m], secondsSince(start));
            setting.stamps[m] = stats.stamps;
        }
    }
}

// Measures all settings of as many threads, each method prepared first once.
void measureSettings(const std::shared_ptr<const Volume>& volume, const RenderOptions& options,
                     int rounds, std::span<Setting> settings) {
    const ThreadLimit limit(settings.front().threads);
    for (std::size_t first = 0; first < kMethods.size(); ++first) {
        Scenes scenes(volume, options, first);
        for (Setting& setting : settings) {
            CameraOptions at;
            at.view = setting.view;
            at.sizePixels = setting.size;
            const Camera camera = makeCamera(at, *volume);
            Setting unused = setting;
            addRounds(scenes, camera, 1, unused);  // prepares
            addRounds(scenes, camera, rounds, setting);
            for (int more = 0; more < 3 && setting.loss() > 0.05; ++more)
                addRounds(scenes, camera, (rounds + 2) / 3, setting);
        }
    }
}

void measureFile(const char* file, const RenderOptions& options, int rounds,
                 std::vector<double>& losses, std::vector<double>& measured) {
    const auto volume = std::make_shared<const Volume>(readVolume(file));
    for (const int threads : {1, 2}) {
        std::vector<Setting> settings;
        for (const char* view : kViews)
            for (const glm::ivec2& size : kSizes) settings.push_back({threads, view, size});
        measureSettings(volume, options, rounds, settings);
        for (const Setting& setting : settings) {
            losses.push_back(setting.loss());
            measured.push_back(setting.measuredLoss());
            std::printf("%-24s %d %-6s %4dx%-4d %9.3f %9.3f %9.3f %-6s %6.1f %6.1f\n",
                        std::filesystem::path(file).filename().c_str(), threads, setting.view,
                        setting.size.x, setting.size.y, 1e3 * setting.least[0],
                        1e3 * setting.least[1], 1e3 * setting.least[2], setting.choice(),
                        100 * measured.back(), 100 * losses.back());
            std::fflush(stdout);
        }
    }
}

void printSpread(const char* how, std::vector<double> losses) {
    std::sort(losses.begin(), losses.end());
    const auto within = std::upper_bound(losses.begin(), losses.end(), 0.05) - losses.begin();
    std::printf("%s: of %zu settings %.1f %% lose at most 5 %%; median %.1f %%, most %.1f %%\n",
                how, losses.size(), 100.0 * double(within) / double(losses.size()),
                100 * losses[losses.size() / 2], 100 * losses.back());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: auto_benchmark ROUNDS TRANSFER_FUNCTION.json FILE...\n");
        return 2;
    }
    try {
        RenderOptions options;
        options.optics.transferFunction = readTransferFunction(argv[2]);
        std::vector<double> losses, measured;
        for (int i = 3; i < argc; ++i)
            measureFile(argv[i], options, std::max(1, std::atoi(argv[1])), losses, measured);
        printSpread("by the clock", measured);
        printSpread("by its choices", losses);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "auto_benchmark: %s\n", error.what());
        return 1;
    }
    return 0;
}
