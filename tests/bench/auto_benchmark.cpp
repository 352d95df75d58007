// SPDX-License-Identifier: Apache-2.0
// How much longer `auto` takes than the quickest of the methods that it may choose from: volumes,
// views, sizes and threads, methods taking turns in rounds of one picture each. Prints a line for
// each setting: milliseconds of `sparse`, `delta` and `auto`, least of all rounds, and what `auto`
// loses, in percent; then how that is spread. All is prepared anew in each of three orders, for
// what is prepared first may lie better in memory: pictures of a millisecond or two differ by a
// fifth for that alone. A third of the rounds more are made where `auto` seems to lose more than 5
// %, lest it be chance. `traditional`, which `auto` never is, is left out.
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

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"
#include "stopwatch.h"

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
            SplatOptions ofMethod = options;
            ofMethod.method = kMethods[m];
            of[m] = std::make_unique<PreparedScene>(Scene{volume, options.optics}, ofMethod);
        }
    }
    std::size_t methodAt(std::size_t i) const { return (first + i) % kMethods.size(); }

    std::size_t first;
    std::array<std::unique_ptr<PreparedScene>, 3> of;
    std::array<Renderer, 3> renderers;
};

// Adds rounds to the least times of each method.
void addRounds(Scenes& scenes, const Camera& camera, int rounds, std::array<double, 3>& least) {
    Image image(camera.sizePixels);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < kMethods.size(); ++i) {
            const std::size_t m = scenes.methodAt(i);
            const Clock::time_point start = Clock::now();
            scenes.renderers[m].render(*scenes.of[m], camera, image);
            least[m] = std::min(least[m], secondsSince(start));
        }
    }
}

double lossOf(const std::array<double, 3>& least) {
    return least[2] / std::min(least[0], least[1]) - 1;
}

struct Setting {
    int threads;
    const char* view;
    glm::ivec2 size;
    std::array<double, 3> least{1e300, 1e300, 1e300};
};

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
            const Camera camera =
                makeCamera(at, volume->box, volume->worldFromIndex, volume->space);
            std::array<double, 3> unused{};
            addRounds(scenes, camera, 1, unused);  // prepares
            addRounds(scenes, camera, rounds, setting.least);
            for (int more = 0; more < 3 && lossOf(setting.least) > 0.05; ++more)
                addRounds(scenes, camera, (rounds + 2) / 3, setting.least);
        }
    }
}

void measureFile(const char* file, const RenderOptions& options, int rounds,
                 std::vector<double>& losses) {
    const auto volume = std::make_shared<const Volume>(readVolume(file));
    for (const int threads : {1, 2}) {
        std::vector<Setting> settings;
        for (const char* view : kViews)
            for (const glm::ivec2& size : kSizes) settings.push_back({threads, view, size});
        measureSettings(volume, options, rounds, settings);
        for (const auto& [_, view, size, least] : settings) {
            losses.push_back(lossOf(least));
            std::printf("%-24s %d %-6s %4dx%-4d %9.3f %9.3f %9.3f %6.1f\n",
                        std::filesystem::path(file).filename().c_str(), threads, view, size.x,
                        size.y, 1e3 * least[0], 1e3 * least[1], 1e3 * least[2],
                        100 * losses.back());
            std::fflush(stdout);
        }
    }
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
        std::vector<double> losses;
        for (int i = 3; i < argc; ++i)
            measureFile(argv[i], options, std::max(1, std::atoi(argv[1])), losses);
        std::sort(losses.begin(), losses.end());
        const auto within = std::upper_bound(losses.begin(), losses.end(), 0.05) - losses.begin();
        std::printf("%zu settings: %.1f %% lose at most 5 %%; median %.1f %%, most %.1f %%\n",
                    losses.size(), 100.0 * double(within) / double(losses.size()),
                    100 * losses[losses.size() / 2], 100 * losses.back());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "auto_benchmark: %s\n", error.what());
        return 1;
    }
    return 0;
}
