// SPDX-License-Identifier: Apache-2.0
// What threads are worth: how many times as fast as one of them several make pictures of a scene
// that is prepared, one after the other, and beside it as many pictures at once, each on a thread
// of its own, which share nothing: what the machine can give. The three take turns in rounds of a
// few pictures, for on a shared machine its speed changes in seconds. Prints milliseconds of one
// thread, and the two ratios, medians of all rounds with their quartiles.
//   parallel_benchmark ROUNDS THREADS TRANSFER_FUNCTION.json FILE...
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#include "base/progress.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"

namespace {

using namespace deltasplat;

double partOf(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    return values[std::size_t(part * double(values.size() - 1))];
}

// Makes pictures, over and over, in memory of its own.
class Pictures {
  public:
    Pictures(const PreparedScene& scene, const Camera& camera)
        : scene_(scene), camera_(camera), image_(camera.sizePixels) {}

    // Returns the median of seconds a picture, after some to warm up.
    double seconds(int threads) {
        constexpr int kWarmUp = 3;
        constexpr int kPictures = 12;
        const ThreadLimit limit(threads);
        std::vector<double> seconds;
        for (int i = 0; i < kWarmUp + kPictures; ++i) {
            const Clock::time_point start = Clock::now();
            scene_.render(camera_, image_);
            if (i >= kWarmUp) seconds.push_back(secondsSince(start));
        }
        return partOf(seconds, 0.5);
    }

  private:
    const PreparedScene& scene_;
    const Camera& camera_;
    Image image_;
};

// Pictures a second of several at once, each on a thread.
double atOnce(std::vector<Pictures>& pictures) {
    std::vector<double> seconds(pictures.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < pictures.size(); ++i)
        threads.emplace_back([&, i] { seconds[i] = pictures[i].seconds(1); });
    for (std::thread& thread : threads) thread.join();
    double perSecond = 0;
    for (const double one : seconds) perSecond += 1 / one;
    return perSecond;
}

void measure(const char* file, const char* transferFunction, int rounds, int threads) {
    const auto volume = std::make_shared<const Volume>(readVolume(file));
    RenderOptions options;
    options.optics.transferFunction = readTransferFunction(transferFunction);
    options.camera.direction = glm::dvec3(-1, 0.8, -0.6);
    options.camera.up = glm::dvec3(0, 0, 1);
    const PreparedScene scene({volume, options.optics}, options.splat);
    const Camera camera = makeCamera(options.camera, *volume);
    std::vector<Pictures> pictures;
    for (int i = 0; i < threads; ++i) pictures.emplace_back(scene, camera);
    std::vector<double> one;
    std::vector<double> shared;
    std::vector<double> apart;
    for (int round = 0; round < rounds; ++round) {
        one.push_back(pictures.front().seconds(1));
        shared.push_back(one.back() / pictures.front().seconds(threads));
        apart.push_back(one.back() * atOnce(pictures));
    }
    std::printf(
        "%s\n  one thread %.2f ms; %d threads %.2f times as fast (%.2f to %.2f); "
        "%d pictures at once %.2f (%.2f to %.2f)\n",
        file, 1e3 * partOf(one, 0.5), threads, partOf(shared, 0.5), partOf(shared, 0.25),
        partOf(shared, 0.75), threads, partOf(apart, 0.5), partOf(apart, 0.25),
        partOf(apart, 0.75));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        std::fprintf(stderr,
                     "usage: parallel_benchmark ROUNDS THREADS TRANSFER_FUNCTION.json FILE...\n");
        return 2;
    }
    try {
        for (int i = 4; i < argc; ++i) {
            measure(argv[i], argv[3], std::max(1, std::atoi(argv[1])),
                    std::max(1, std::atoi(argv[2])));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "parallel_benchmark: %s\n", error.what());
        return 1;
    }
    return 0;
}
