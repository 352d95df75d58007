// SPDX-License-Identifier: Apache-2.0
// The inner loops of splatting, compositing and warping by themselves, in caches that are warm:
// what is left to gain there. Times are of one stamp, tile or pixel (Google Benchmark's options
// apply):
//   kernel_benchmark --benchmark_filter=stamps
#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <utility>
#include <vector>

#include "composite/over_kernels.h"
#include "deltasplat/threads.h"
#include "screen/warp.h"
#include "splat/cell_kernels.h"
#include "splat/stamp_kernels.h"
#include "splat/tile_kernels.h"

namespace {

using namespace deltasplat;

// As many items a second as `itemsEach` for each iteration.
void countItems(benchmark::State& state, std::size_t itemsEach) {
    state.SetItemsProcessed(state.iterations() * std::int64_t(itemsEach));
}

// Footprints of a slice of 64x64 voxels, block by block as the splatter stamps them.
void stamps(benchmark::State& state) {
    const int channels = int(state.range(0));
    const Footprint footprint = makeFootprint(1, {0.5, -0.5}, 1, int(state.range(1)));
    const StampWeights weights(footprint, channels);
    constexpr std::size_t kPitch =
        136;  // pixels; of a power of two, rows would get in each other's way
    std::vector<std::int32_t> sheet(channels * kPitch * 136);
    const std::vector<ClassTable::Color> colors = {{}, {3000, 2000, 1000, 500}};
    std::array<std::uint16_t, 64> classes;
    classes.fill(1);
    std::array<std::uint32_t, 64> places;
    for (int n = 0; n < 64; ++n) places[n] = std::uint32_t(n / 8 * kPitch + n % 8);
    std::vector<BlockStamps> blocks;
    for (std::size_t block = 0; block < 64; ++block) {
        const std::size_t place = 8 * (block / 8) * kPitch + 8 * (block % 8);
        blocks.push_back({~std::uint64_t{0}, classes.data(), nullptr, &sheet[channels * place]});
    }
    for (auto _ : state) {
        stampWhole(blocks, colors.data(), weights, {places.data(), channels * kPitch});
        benchmark::ClobberMemory();
    }
    countItems(state, std::size_t{64} * 64);
}
BENCHMARK(stamps)->ArgNames({"channels", "width"})->ArgsProduct({{1, 4}, {3, 5, 6, 13}});

// Makes a row of tiles that are touched all over, again and again.
// @param splat  (plane of colours, its pitch, row, touched, full)
template <typename Splat>
void makeTiles(benchmark::State& state, int channels, const Splat& splat) {
    constexpr int kTiles = 32;
    const std::size_t pitch = std::size_t(channels) * 8 * (kTiles + 4);
    const std::vector<std::int16_t> plane(pitch * 24, 1234);  // however rows lie
    std::vector<std::int32_t> sheet(pitch * 8);
    const std::vector<std::uint8_t> touched(kTiles, 0xFF);
    std::vector<std::uint8_t> full(kTiles);
    for (auto _ : state) {
        splat(&plane[8 * pitch + 128], pitch, TileRow{sheet.data(), pitch}, touched, full);
        benchmark::ClobberMemory();
    }
    countItems(state, kTiles);
}

void tiles(benchmark::State& state) {
    const int channels = int(state.range(0));
    const int resolution = int(state.range(1));
    const Footprint footprint = makeFootprint(0.3, {0.5, -0.5}, resolution, 2 * resolution + 1);
    const TileWeights weights(footprint, channels);
    makeTiles(state, channels,
              [&](const std::int16_t* plane, std::size_t pitch, const TileRow& row,
                  const auto& touched, auto& full) {
                  splatTiles(weights, {plane, 2 * pitch}, {}, row, touched, full);
              });
}
BENCHMARK(tiles)->ArgNames({"channels", "r"})->ArgsProduct({{1, 4}, {1, 2}});

// Of footprints that reach farther: sheet pixels a voxel, and widths.
constexpr std::pair<int, int> kWide[] = {{1, 5},  {1, 7},  {2, 7},  {2, 9}, {2, 11},
                                         {3, 10}, {3, 15}, {4, 13}, {4, 21}};

void cells(benchmark::State& state) {
    const int channels = int(state.range(0));
    const Footprint footprint =
        makeFootprint(0.6, {0.5, -0.5}, int(state.range(1)), int(state.range(2)));
    const CellWeights weights(footprint, channels);
    makeTiles(state, channels,
              [&](const std::int16_t* plane, std::size_t pitch, const TileRow& row,
                  const auto& touched, auto& full) {
                  splatCells(weights, {plane, pitch, {0, 0}}, row, touched, full);
              });
}
BENCHMARK(cells)->ArgNames({"channels", "r", "width"})->Apply([](auto* cells) {
    for (const int channels : {1, 4}) {
        for (const auto& [r, width] : kWide) cells->Args({channels, r, width});
    }
});

// Spans of so many pixels of a sheet, read between its pixels or straight.
void over(benchmark::State& state) {
    const int channels = int(state.range(0));
    const auto pixels = std::size_t(state.range(1));
    const float fraction = state.range(2) != 0 ? 0.3f : 0.0f;
    constexpr std::size_t kRows = 64;
    const std::size_t pitch = channels * (pixels + 16);
    std::vector<std::int32_t> sheet(pitch * (kRows + 1), 100000);
    std::vector<float> layer(pitch * kRows, 0.25f);
    std::vector<OverSpan> spans;
    for (std::size_t y = 0; y < kRows; ++y) {
        spans.push_back({y * pitch, &layer[y * pitch], std::uint32_t(pixels), 1});
    }
    const OverSheets sheets{{sheet.data()}, pitch};
    const std::vector<glm::vec4> scales{glm::vec4(1e-12f)};
    const OverWeights weights({fraction, fraction}, scales, channels);
    for (auto _ : state) {
        overSpans(spans, sheets, weights);
        benchmark::ClobberMemory();
    }
    countItems(state, kRows * pixels);
}
BENCHMARK(over)
    ->ArgNames({"channels", "pixels", "shifted"})
    ->ArgsProduct({{1, 4}, {9, 129}, {0, 1}});

// A raster of 256x256 pixels, twice as large in the picture and turned.
void warpPicture(benchmark::State& state) {
    const int channels = int(state.range(0));
    std::vector<float> values(std::size_t(channels) * 256 * 256, 0.5f);
    const Raster raster{{0, 0}, {256, 256}, values.data(), channels, {1, 1, 1}};
    const glm::dmat3 map(0.45, 0.1, 0, -0.1, 0.45, 0, 40, -10, 1);
    Image picture({512, 512});
    const ThreadLimit limit(1);
    for (auto _ : state) {
        warp(raster, map, WarpFilter::kSharp, picture);
        benchmark::ClobberMemory();
    }
    countItems(state, 512 * 512);
}
BENCHMARK(warpPicture)->ArgName("channels")->Arg(1)->Arg(4);

}  // namespace

BENCHMARK_MAIN();
