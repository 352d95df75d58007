// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_runs.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "deltasplat/threads.h"

namespace deltasplat {
namespace {

constexpr std::size_t kMethodCount = kBenchMethods.size();

std::size_t placeOf(Method method) {
    return std::size_t(std::find(kBenchMethods.begin(), kBenchMethods.end(), method) -
                       kBenchMethods.begin());
}

// Equal numbers may still differ as bits: 0 and -0.
bool sameBits(const Image& a, const Image& b) {
    return a.rgba.size() == b.rgba.size() &&
           std::memcmp(a.rgba.data(), b.rgba.data(), a.rgba.size() * sizeof(float)) == 0;
}

// What is known while the rounds go on.
class Rounds {
  public:
    Rounds(const Volume& volume, const RenderOptions& options, BenchRun& run)
        : volume_(volume), options_(options), run_(run) {}

    void renderOnce(std::size_t place, bool counts, const Listener& listener) {
        options_.splat.method = kBenchMethods[place];
        RenderResult result = render(volume_, options_, listener);
        if (options_.splat.method == Method::kDelta) run_.stats = result.stats;
        if (counts) stats_[place].push_back(result.stats);
        run_.methods[place].stamps = result.stats.stamps;
        compare(std::move(result.image), run_.methods[place]);
    }

    void summarize() {
        std::vector<double> prepare;
        for (std::size_t place = 0; place < kMethodCount; ++place) {
            MethodRuns& method = run_.methods[place];
            method.method = kBenchMethods[place];
            method.prepare = timingOf(secondsOf(place, &RenderStats::prepareSeconds));
            method.splat = timingOf(secondsOf(place, &RenderStats::splatSeconds));
            method.composite = timingOf(secondsOf(place, &RenderStats::compositeSeconds));
            method.warp = timingOf(secondsOf(place, &RenderStats::warpSeconds));
            method.render = timingOf(secondsOf(place, &RenderStats::renderSeconds));
            for (const RenderStats& one : stats_[place]) prepare.push_back(one.prepareSeconds);
        }
        run_.prepare = timingOf(std::move(prepare));
    }

  private:
    std::vector<double> secondsOf(std::size_t place, double RenderStats::*stage) const {
        std::vector<double> seconds;
        for (const RenderStats& one : stats_[place]) seconds.push_back(one.*stage);
        return seconds;
    }

    void compare(Image image, MethodRuns& method) {
        if (run_.picture.rgba.empty()) {
            run_.picture = std::move(image);
        } else if (!sameBits(run_.picture, image)) {
            const PictureDifference difference = differenceOf(run_.picture, image);
            run_.identical = false;
            run_.maxDifference = std::max({run_.maxDifference, difference.color, difference.alpha});
            if (!method.differs) method.differs = std::move(image);
        }
    }

    const Volume& volume_;
    RenderOptions options_;
    BenchRun& run_;
    std::array<std::vector<RenderStats>, kMethodCount> stats_;
};

ToleranceRuns measureTolerance(const Volume& volume, RenderOptions options, const BenchRun& run,
                               const Listener& listener) {
    ToleranceRuns runs;
    runs.tolerance = options.splat.tolerance;
    runs.bound = {run.stats.errorBoundColor, run.stats.errorBoundAlpha};
    options.splat.method = Method::kDelta;
    options.splat.tolerance = {};
    // Nor are slices joined with a tolerance.
    options.splat.mostJoined = 1;
    RenderResult exact = render(volume, options, listener);
    runs.measured = differenceOf(run.picture, exact.image);
    runs.exact = std::move(exact.image);
    runs.exactDeltas = exact.stats.deltas;
    runs.exactStamps = exact.stats.stamps;
    return runs;
}

}  // namespace

Timing timingOf(std::vector<double> seconds) {
    if (seconds.empty()) return {};
    std::sort(seconds.begin(), seconds.end());
    const std::size_t middle = seconds.size() / 2;
    const double lower = seconds[(seconds.size() - 1) / 2];
    return {seconds.front(), (lower + seconds[middle]) / 2};
}

double MethodRuns::nanosecondsPerStamp() const {
    return stamps > 0 ? 1e9 * splat.median / double(stamps) : 0;
}

PictureDifference differenceOf(const Image& a, const Image& b) {
    PictureDifference largest;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double difference = std::abs(double(a.rgba[i]) - double(b.rgba[i]));
        double& most = i % 4 == 3 ? largest.alpha : largest.color;
        most = std::max(most, difference);
    }
    return largest;
}

const MethodRuns& BenchRun::of(Method method) const {
    return methods[placeOf(method)];
}

double BenchRun::speedup(Method a, Method b) const {
    const double seconds = of(b).render.median;
    if (!(seconds > 0)) return std::numeric_limits<double>::quiet_NaN();
    return of(a).render.median / seconds;
}

double BenchRun::comparability() const {
    return stats.voxels > 0 ? 1 - double(stats.deltas) / double(stats.voxels) : 1;
}

BenchRun measureMethods(const Volume& volume, const RenderOptions& options, int repeats,
                        const Listener& listener) {
    BenchRun run;
    run.dims = volume.box().dims();
    run.threads = threadCount();
    run.repeats = repeats;
    const bool exactToo = !options.splat.tolerance.isExact();
    const double pictures = double(kMethodCount) * (repeats + 1) + (exactToo ? 1 : 0);
    double done = 0;
    // The share stands still while a picture is made: asked for interrupts, nothing to show.
    Listener during;
    during.progress = [&](double) { listener.report(done / pictures); };

    Rounds rounds(volume, options, run);
    for (int round = 0; round <= repeats; ++round) {
        for (std::size_t i = 0; i < kMethodCount; ++i) {
            listener.report(done / pictures);
            rounds.renderOnce((std::size_t(round) + i) % kMethodCount, round > 0, during);
            ++done;
        }
    }
    rounds.summarize();
    if (exactToo) run.tolerance = measureTolerance(volume, options, run, during);
    listener.report(1);
    return run;
}

}  // namespace deltasplat
