// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target without a fuzzer: on the files named, or on seeded mutations of its own seeds.
//   TARGET_replay [FILE...]          replays files
//   TARGET_replay --count N          N mutations of every seed (default 300)
//   TARGET_replay --digests N        the same, and prints what became of those that were accepted
//   TARGET_replay --mutation S I FILE  writes mutation I of seed S, as --digests names them
//   TARGET_replay --write FOLDER     writes the seeds, as a corpus for libFuzzer
#include <sys/resource.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

#include "fuzz/fuzz_target.h"

namespace {

using deltasplat::fuzz::seeds;

void run(const std::string& bytes) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

// A reader that believes a size in a file must meet a limit, not this machine's memory.
void capMemory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const rlimit limit{rlim_t{4} << 30, rlim_t{4} << 30};
    setrlimit(RLIMIT_AS, &limit);
#endif
}

std::string mutated(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    for (std::size_t times = 1 + below(3); times > 0 && !bytes.empty(); --times) {
        const std::size_t at = below(bytes.size());
        switch (below(6)) {
            case 0:
                bytes[at] = char(bytes[at] ^ 1 << below(8));
                break;
            case 1:
                bytes[at] = char(random());
                break;
            case 2: {  // a count or a size that is far off
                const std::uint32_t odd[] = {0, 0xffffffffu, 0x7fffffffu, 0x10000,
                                             std::uint32_t(random())};
                const std::size_t width = std::min<std::size_t>(4, bytes.size() - at);
                std::memcpy(bytes.data() + at, &odd[below(5)], width);
                break;
            }
            case 3:
                bytes.resize(at);
                break;
            case 4:
                bytes.erase(at, 1 + below(16));
                break;
            default:
                bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(16)));
        }
    }
    return bytes;
}

void replayFile(const char* path) {
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    run(bytes.str());
}

void writeSeeds(const std::string& folder) {
    int number = 0;
    for (const std::string& seed : seeds()) {
        std::ofstream(folder + "/seed" + std::to_string(number++), std::ios::binary) << seed;
    }
}

// Writes what replayMutations calls mutation `index` of a seed.
void writeMutation(int seed, int index, const char* file) {
    const std::string sound = seeds().at(std::size_t(seed) - 1);
    std::mt19937 random{unsigned(seed)};
    std::string bytes = sound;
    for (int i = 0; i < index; ++i) bytes = mutated(sound, random);
    std::ofstream(file, std::ios::binary) << bytes;
}

void replayMutations(int count, bool digests) {
    int number = 0;
    for (const std::string& seed : seeds()) {
        std::mt19937 random(unsigned(++number));
        for (int i = 0; i <= count; ++i) {
            run(i == 0 ? seed : mutated(seed, random));
            const std::uint64_t digest = deltasplat::fuzz::takeDigest();
            if (digests && digest != 0) {
                std::printf("seed %d mutation %d: %016" PRIx64 "\n", number, i, digest);
            }
        }
    }
    std::printf("%d seeds, %d mutations each\n", number, count);
}

}  // namespace

int main(int argc, char** argv) {
    capMemory();
    if (argc == 3 && std::strcmp(argv[1], "--write") == 0) {
        writeSeeds(argv[2]);
    } else if (argc == 3 && std::strcmp(argv[1], "--count") == 0) {
        replayMutations(std::stoi(argv[2]), false);
    } else if (argc == 3 && std::strcmp(argv[1], "--digests") == 0) {
        replayMutations(std::stoi(argv[2]), true);
    } else if (argc == 5 && std::strcmp(argv[1], "--mutation") == 0) {
        writeMutation(std::stoi(argv[2]), std::stoi(argv[3]), argv[4]);
    } else if (argc == 1) {
        replayMutations(300, false);
    }
    for (int i = 1; i < argc && argv[i][0] != '-' && argv[1][0] != '-'; ++i) replayFile(argv[i]);
    return 0;
}
