// SPDX-License-Identifier: Apache-2.0
// Renders a volume on 1 to 32 threads and prints, for each number, the time that passes for one
// picture and what all processors together spend on it, with taking differences. How much the
// latter grows says what more threads cost, even where the machine has too few processors for them.
//   thread_benchmark PICTURES TRANSFER_FUNCTION.json FILE...
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "base/progress.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"

namespace {

using namespace deltasplat;

// Seconds that all threads of this process have worked.
double processorSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void measure(const Volume& volume, const RenderOptions& options, int pictures) {
    for (const int threads : {1, 2, 4, 8, 16, 32}) {
        const ThreadLimit limit(threads);
        render(volume, options);  // warms up
        const Clock::time_point start = Clock::now();
        const double before = processorSeconds();
        for (int i = 0; i < pictures; ++i) render(volume, options);
        std::printf("%2d threads: %8.2f ms a picture, %8.2f ms of processors\n", threads,
                    1e3 * secondsSince(start) / pictures,
                    1e3 * (processorSeconds() - before) / pictures);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: thread_benchmark PICTURES TRANSFER_FUNCTION.json FILE...\n");
        return 2;
    }
    try {
        RenderOptions options;
        options.optics.transferFunction = readTransferFunction(argv[2]);
        options.camera.direction = glm::dvec3(-1, 0.8, -0.6);
        options.camera.up = glm::dvec3(0, 0, 1);
        for (int i = 3; i < argc; ++i) {
            std::printf("%s\n", argv[i]);
            measure(readVolume(argv[i]), options, std::max(1, std::atoi(argv[1])));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "thread_benchmark: %s\n", error.what());
        return 1;
    }
    return 0;
}
