// SPDX-License-Identifier: Apache-2.0
#include "screen/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "deltasplat/threads.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

struct OwnedRaster {
    glm::ivec2 min;
    glm::ivec2 size;
    std::vector<float> rgba;

    OwnedRaster(glm::ivec2 first, glm::ivec2 extent, const std::function<float(int, int)>& at)
        : min(first), size(extent), rgba(std::size_t{4} * extent.x * extent.y) {
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                for (int c = 0; c < 4; ++c) {
                    rgba[4 * (std::size_t(y) * size.x + x) + c] = at(min.x + x, min.y + y);
                }
            }
        }
    }
    Raster raster() const { return {min, size, rgba.data(), 4, {}}; }
};

constexpr WarpFilter kFilters[] = {WarpFilter::kSharp, WarpFilter::kMitchell, WarpFilter::kGauss,
                                   WarpFilter::kBox};

// A picture with something in it, of which a warp must leave nothing.
Image usedPicture(glm::ivec2 size) {
    Image picture(size);
    std::fill(picture.rgba.begin(), picture.rgba.end(), 7.0f);
    return picture;
}

glm::dmat3 affine(double xx, double xy, double x0, double yx, double yy, double y0) {
    return {xx, yx, 0, xy, yy, 0, x0, y0, 1};
}

TEST(Warp, PixelCentresOnLatticePointsCopyThem) {
    const OwnedRaster raster({-3, 7}, {20, 20},
                             [](int x, int y) { return (x * 7 + y * 13) % 11 / 11.0f + 0.01f; });
    Image picture({20, 20});
    // Pixel centre (0.5, 0.5) falls on lattice point (-3, 7).
    warp(raster.raster(), affine(1, 0, -3.5, 0, 1, 6.5), WarpFilter::kSharp, picture);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        EXPECT_FLOAT_EQ(picture.rgba[i], raster.rgba[i]);
    }
}

TEST(Warp, ReproducesLinearRampsUnderAnyAffineMap) {
    const auto ramp = [](double x, double y) { return 0.3 + 0.002 * x - 0.003 * y; };
    const OwnedRaster raster({-40, -40}, {80, 80}, [&](int x, int y) { return float(ramp(x, y)); });
    for (const auto& map : {affine(0.7, 0.2, -20, -0.3, 0.8, -10), affine(-0.25, 0, 10, 0, -0.4, 5),
                            affine(0, 1.0, -12, -1.0, 0, 12)}) {
        Image picture({30, 30});
        warp(raster.raster(), map, WarpFilter::kSharp, picture);
        for (int y = 0; y < 30; ++y) {
            for (int x = 0; x < 30; ++x) {
                const glm::dvec3 p = map * glm::dvec3(x + 0.5, y + 0.5, 1);
                EXPECT_NEAR(picture.pixel(x, y)[0], ramp(p.x, p.y), 1e-5);
                EXPECT_NEAR(picture.pixel(x, y)[3], ramp(p.x, p.y), 1e-5);
            }
        }
    }
}

// The same where the raster is halved, once or more often, for the picture is much coarser.
TEST(Warp, ReproducesLinearRampsWhereMuchCoarser) {
    const auto ramp = [](double x, double y) { return 0.3 + 0.0003 * x - 0.0004 * y; };
    const OwnedRaster raster({-401, -300}, {800, 701},
                             [&](int x, int y) { return float(ramp(x, y)); });
    for (const auto& map : {affine(3.1, 0.7, -40, -0.9, 3.3, -10), affine(0, 7.1, -70, -6.4, 0, 60),
                            affine(4, 0, -44, 0, 1.2, -20), affine(13, 0, -130, 0, -14, 140)}) {
        Image picture({20, 20});
        warp(raster.raster(), map, WarpFilter::kSharp, picture);
        for (int y = 0; y < 20; ++y) {
            for (int x = 0; x < 20; ++x) {
                const glm::dvec3 p = map * glm::dvec3(x + 0.5, y + 0.5, 1);
                ASSERT_NEAR(picture.pixel(x, y)[3], ramp(p.x, p.y), 5e-6) << x << "," << y;
            }
        }
    }
}

// A wave of three pixels keeps its height and place, whether the raster is halved or not.
TEST(Warp, FineWavesStayWhereMuchCoarser) {
    double before = 0;
    for (const double step : {2.9, 3.1, 5.9, 6.1, 11.0}) {
        const double period = 3 * step;
        const OwnedRaster waves({0, 0}, {700, 60}, [&](int x, int) {
            return float(0.5 + 0.5 * std::cos(2 * M_PI * x / period));
        });
        Image picture({30, 1});
        const double first = 20 * step;
        warp(waves.raster(), affine(step, 0, first, 0, step, 30), WarpFilter::kSharp, picture);
        // The part of the wave that is in step with it, and the one that is not.
        double in = 0;
        double out = 0;
        for (int x = 0; x < 30; ++x) {
            const double phase = 2 * M_PI * (first + step * (x + 0.5)) / period;
            in += (picture.pixel(x, 0)[3] - 0.5) * std::cos(phase) / 15;
            out += (picture.pixel(x, 0)[3] - 0.5) * std::sin(phase) / 15;
        }
        EXPECT_NEAR(out, 0, 0.01) << step;
        EXPECT_GT(in, 0.3) << step;
        if (before > 0) {
            EXPECT_NEAR(in, before, 0.04) << step;
        }
        before = in;
    }
}

// What is written to a pixel does not depend on which others are: of rasters that are full, or hold
// a few discs, of one channel, in spans.
TEST(Warp, PartsHaveTheSameBits) {
    const glm::ivec2 size(1000, 900);
    const OwnedRaster full({-7, 3}, size,
                           [](int x, int y) { return float((x * x + 3 * y) % 17) / 17; });
    std::vector<float> values(std::size_t(size.x) * size.y);
    std::vector<glm::ivec2> spans;
    for (int y = 0; y < size.y; ++y) {
        glm::ivec2 span(size.x, 0);
        for (int x = 0; x < size.x; ++x) {
            const glm::ivec2 place = glm::ivec2(x, y) % 300 - 150;
            if (place.x * place.x + place.y * place.y > 40 * 40) continue;
            values[std::size_t(y) * size.x + x] = float((x * x + 3 * y) % 17 + 1) / 18;
            span = {std::min(span.x, x), std::max(span.y, x + 1)};
        }
        spans.push_back(span.x < span.y ? span : glm::ivec2(0));
    }
    const Raster discs{{-7, 3}, size, values.data(), 1, glm::vec3(0.5f), spans};
    for (const Raster& raster : {full.raster(), discs}) {
        for (const double step : {0.7, 1.6, 3.4, 7.3, 26.0}) {
            const glm::dmat3 map = affine(step, 0.3 * step, -9, -0.4 * step, step, 40);
            Image whole({90, 70});
            warp(raster, map, WarpFilter::kSharp, whole);
            for (const glm::ivec2 first :
                 {glm::ivec2(0, 0), glm::ivec2(13, 9), glm::ivec2(61, 44)}) {
                Image part = usedPicture({29, 26});
                warp(raster, map, WarpFilter::kSharp, PicturePart(part, first, whole.size));
                for (int y = 0; y < part.size.y; ++y) {
                    for (int i = 0; i < 4 * part.size.x; ++i) {
                        ASSERT_EQ(part.pixel(0, y)[i], whole.pixel(first.x, first.y + y)[i])
                            << step << " " << i / 4 << "," << y;
                    }
                }
            }
        }
    }
}

TEST(Warp, SameBitsAtEverySimdLevel) {
    const OwnedRaster all({0, 0}, {200, 150},
                          [](int x, int y) { return float((x * x + 3 * y) % 17) / 17; });
    std::vector<float> values;
    for (std::size_t i = 0; i < all.rgba.size(); i += 4) values.push_back(all.rgba[i]);
    const Raster one{all.min, all.size, values.data(), 1, {0.5f, 2.0f, 0.3f}};
    for (const Raster& raster : {all.raster(), one}) {
        for (const WarpFilter filter : kFilters) {
            for (const double step : {0.6, 1.3, 1.8, 2.6, 3.7, 9.0}) {
                std::vector<float> ofFirstLevel;
                test::atEveryLevel([&] {
                    Image picture({70, 50});
                    const glm::dmat3 map = affine(step, 0.4, -2, -0.2, 0.8 * step, 4);
                    warp(raster, map, filter, picture);
                    if (ofFirstLevel.empty()) ofFirstLevel = picture.rgba;
                    EXPECT_EQ(picture.rgba, ofFirstLevel) << int(filter) << " " << step;
                });
            }
        }
    }
}

// A picture coarser than the raster must average it, not sample it.
TEST(Warp, MinificationAveragesFineStripes) {
    const OwnedRaster stripes({0, 0}, {256, 256}, [](int x, int) { return x % 2 ? 1.0f : 0.0f; });
    Image picture({32, 32});
    warp(stripes.raster(), affine(8, 0, 0, 0, 8, 0), WarpFilter::kSharp, picture);
    for (int x = 4; x < 28; ++x) EXPECT_NEAR(picture.pixel(x, 16)[1], 0.5, 0.005);
}

// Hard edges and fine stripes, magnified and not: no pixel leaves the range of those around it.
TEST(Warp, NoFilterOvershoots) {
    const auto high = [](int x, int y) { return (x / 5 + y / 7) % 2 == 0; };
    const OwnedRaster edges({0, 0}, {120, 120},
                            [&](int x, int y) { return high(x, y) ? 3.0f : 0.75f; });
    for (const WarpFilter filter : kFilters) {
        for (const double step : {0.1, 0.41, 0.7, 0.97, 1.3, 2.2, 3.3}) {
            Image picture({25, 25});
            const double first = 60 - 12.5 * step;
            warp(edges.raster(), affine(step, 0.2, first, -0.15, step, first), filter, picture);
            for (const float value : picture.rgba) {
                EXPECT_GE(value, 0.75f - 1e-6f) << step;
                EXPECT_LE(value, 3.0f + 1e-6f) << step;
            }
        }
    }
}

// Where the sharp filter is clamped, it is to the four nearest points.
TEST(Warp, SharpStaysWithinTheNearestPoints) {
    const auto at = [](int x, int y) { return float((x * 31 + y * 17) % 23) / 22; };
    const OwnedRaster raster({0, 0}, {40, 40}, at);
    Image picture({90, 90});
    const glm::dmat3 map = affine(0.37, 0.03, 3, -0.05, 0.35, 6);
    warp(raster.raster(), map, WarpFilter::kSharp, picture);
    int clamped = 0;
    for (int y = 0; y < 90; ++y) {
        for (int x = 0; x < 90; ++x) {
            const glm::dvec3 p = map * glm::dvec3(x + 0.5, y + 0.5, 1);
            // On a line between cells either is right.
            if (std::abs(p.x - std::round(p.x)) < 1e-6 || std::abs(p.y - std::round(p.y)) < 1e-6)
                continue;
            const int i = int(std::floor(p.x));
            const int j = int(std::floor(p.y));
            const auto [low, high] =
                std::minmax({at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
            const float value = picture.pixel(x, y)[3];
            ASSERT_GE(value, low);
            ASSERT_LE(value, high);
            clamped += value == low || value == high;
        }
    }
    EXPECT_GT(clamped, 100);
}

// Where a filter is clamped it must not be to other points on the two sides of a lattice point.
TEST(Warp, NoFilterJumps) {
    const OwnedRaster raster({0, 0}, {60, 60},
                             [](int x, int y) { return float((x * x * 31 + y * 17) % 23) / 22; });
    for (const WarpFilter filter : kFilters) {
        for (const double stretch : {1.0, 1.4}) {
            Image fine({12000, 1});
            // Along x in steps of a thousandth; what y's step is makes the filter along it wide.
            warp(raster.raster(), affine(0.001, stretch, 20, 0, stretch, 30.3), filter, fine);
            for (int x = 1; x < 12000; ++x) {
                ASSERT_NEAR(fine.pixel(x, 0)[3], fine.pixel(x - 1, 0)[3], 0.02)
                    << int(filter) << " " << stretch << " at " << x;
            }
        }
    }
}

// The same where the raster is halved: stripes that move slowly do not jump where the filter comes
// to read other points.
TEST(Warp, HalvedDoesNotJump) {
    const OwnedRaster raster({0, 0}, {200, 200},
                             [](int x, int) { return x / 6 % 2 == 0 ? 1.0f : 0.0f; });
    const auto largestStep = [&](double stretch) {
        Image fine({12000, 1});
        // Along x in steps of a thousandth; what y's step is makes the filter along it wide.
        warp(raster.raster(), affine(0.001, stretch, 100 - stretch / 2, 0, stretch, 100),
             WarpFilter::kSharp, fine);
        double largest = 0;
        for (int x = 1; x < 12000; ++x) {
            const double step = fine.pixel(x, 0)[3] - fine.pixel(x - 1, 0)[3];
            largest = std::max(largest, std::abs(step));
        }
        return largest;
    };
    EXPECT_GT(largestStep(2.95), 1e-3);
    for (const double stretch : {2.95, 3.0, 3.01, 3.05, 3.3, 4.0, 5.9, 6.0, 6.02, 7.0, 12.0})
        EXPECT_LT(largestStep(stretch), 0.0025) << stretch;
}

// What is opaque is so from a pixel and a half behind its edge on, whatever fits the wide filter.
TEST(Warp, EdgesDoNotShowFarInside) {
    for (const double step : {2.9, 3.0, 3.1, 3.6, 4.5, 6.0, 7.0, 12.0}) {
        const OwnedRaster opaque({0, 0}, {int(40 * step), 60}, [](int, int) { return 1.0f; });
        for (const double offset : {0.0, 0.3, 0.5, 0.9}) {
            Image picture({40, 1});
            warp(opaque.raster(), affine(step, 0, offset, 0, step, 30 - 0.5 * step),
                 WarpFilter::kSharp, picture);
            int inside = 0;
            for (int x = 0; x < 40; ++x) {
                const double place = offset + step * (x + 0.5);
                if (place < 1.5 * step || place > int(40 * step) - 1.5 * step) continue;
                ASSERT_NEAR(picture.pixel(x, 0)[3], 1, 1e-5) << step << " " << x;
                ++inside;
            }
            EXPECT_GT(inside, 30);
        }
    }
}

// The largest sum of the magnitudes by which single points show in a pixel.
TEST(Warp, ReturnsHowMuchItCanEnlarge) {
    const OwnedRaster raster({0, 0}, {8, 8}, [](int, int) { return 1.0f; });
    for (const double step : {0.5, 1.0, 1.1, 2.0, 3.0, 6.0, 20.0}) {
        Image picture({4, 4});
        const double gain =
            warp(raster.raster(), affine(step, 0, 0, 0, step, 0), WarpFilter::kSharp, picture);
        const int halvings = step < 3 ? 0 : 1 + int(std::floor(std::log2(step / 3)));
        const FilterTable filter(WarpFilter::kSharp, std::max(1.0, step), halvings);
        double most = 0;
        for (int i = 0; i < 4096; ++i) {
            const float* weights = filter.weights(std::uint32_t(i) << 20);
            double sum = 0;
            for (int tap = 0; tap < filter.taps(); ++tap) sum += std::abs(weights[tap]);
            most = std::max(most, sum);
        }
        EXPECT_NEAR(gain, most * most, 1e-5) << step;
        EXPECT_GT(gain, 1.2 * 1.2 - (step > 1 ? 0.1 : 0)) << step;
        EXPECT_LT(gain, 1.46 * 1.46) << step;
    }
}

// The weight of a point that lies so many raster pixels away.
double plainWeight(WarpFilter filter, double x, double stretch) {
    x = std::abs(x);
    if (filter == WarpFilter::kBox) return std::clamp((stretch + 1) / 2 - x, 0.0, 1.0);
    x /= stretch;
    if (filter == WarpFilter::kGauss)
        return std::max(0.0, std::exp(-x * x / (2 * 0.5 * 0.5)) - std::exp(-4.5));
    // Mitchell and Netravali's formula, as they wrote it.
    const double b = 1.0 / 3;
    const double c = 1.0 / 3;
    const double x2 = x * x;
    const double x3 = x * x * x;
    if (x < 1) return ((12 - 9 * b - 6 * c) * x3 + (-18 + 12 * b + 6 * c) * x2 + 6 - 2 * b) / 6;
    if (x < 2)
        return ((-b - 6 * c) * x3 + (6 * b + 30 * c) * x2 + (-12 * b - 48 * c) * x + 8 * b +
                24 * c) /
               6;
    return 0;
}

// What a filter makes of values along a line, at a place between them.
double plainSum(WarpFilter filter, double place, double stretch,
                const std::function<double(int)>& at) {
    const int reach = int(std::ceil(2 * stretch));
    const int whole = int(std::floor(place));
    double sum = 0;
    double weights = 0;
    double low = 1e9;
    double high = -1e9;
    for (int i = whole - reach + 1; i <= whole + reach; ++i) {
        const double weight = plainWeight(filter, i - place, stretch);
        const double value = at(i);
        sum += weight * value;
        weights += weight;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    return std::clamp(sum / weights, low, high);
}

TEST(Warp, ChosenFiltersAreTheirFormulas) {
    const auto at = [](int x, int y) { return 0.5 + 0.2 * std::sin(0.9 * x) * std::cos(0.7 * y); };
    const OwnedRaster raster({0, 0}, {90, 90}, [&](int x, int y) { return float(at(x, y)); });
    for (const WarpFilter filter : {WarpFilter::kMitchell, WarpFilter::kGauss, WarpFilter::kBox}) {
        for (const double step : {0.45, 1.0, 1.7, 3.0}) {
            Image picture({20, 20});
            const glm::dmat3 map = affine(step, 0, 14.3, 0, step, 12.9);
            warp(raster.raster(), map, filter, picture);
            const double stretch = std::max(1.0, step);
            for (int y = 0; y < 20; ++y) {
                for (int x = 0; x < 20; ++x) {
                    const glm::dvec3 p = map * glm::dvec3(x + 0.5, y + 0.5, 1);
                    const double expected = plainSum(filter, p.x, stretch, [&](int i) {
                        return plainSum(filter, p.y, stretch, [&](int j) { return at(i, j); });
                    });
                    ASSERT_NEAR(picture.pixel(x, y)[3], expected, 3e-4)
                        << int(filter) << " " << step << " " << x << "," << y;
                }
            }
        }
    }
}

TEST(Warp, OutsideOfTheRasterIsTransparent) {
    const OwnedRaster raster({0, 0}, {4, 4}, [](int, int) { return 1.0f; });
    Image picture = usedPicture({64, 64});
    warp(raster.raster(), affine(1, 0, -30, 0, 1, -30), WarpFilter::kSharp, picture);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const bool far = x < 26 || x > 37 || y < 26 || y > 37;
            if (far) {
                EXPECT_EQ(picture.pixel(x, y)[3], 0.0f);
            }
        }
    }
    EXPECT_GT(picture.pixel(31, 31)[3], 0.9f);
}

// A picture so coarse that the filter is wider than the raster, turned so that no column is empty.
TEST(Warp, FilterWiderThanTheRasterReadsNothingOutside) {
    const OwnedRaster raster({0, 0}, {48, 48}, [](int, int) { return 1.0f; });
    for (const double stretch : {10.0, 22.0, 47.0, 500.0, 1e6, 1e12}) {
        Image picture = usedPicture({16, 16});
        const double c = 0.8 * stretch;
        const double s = 0.6 * stretch;
        warp(raster.raster(), affine(c, -s, 24 - 8 * (c - s), s, c, 24 - 8 * (c + s)),
             WarpFilter::kSharp, picture);
        double sum = 0;
        for (const float value : picture.rgba) {
            EXPECT_TRUE(value >= 0 && value <= 1.2f) << stretch;
            sum += value;
        }
        // The picture's sum is the raster's area in pixels, four channels deep.
        const double area = 4 * 48 * 48 / (stretch * stretch);
        if (stretch < 40) {
            EXPECT_NEAR(sum / area, 1, 0.15) << stretch;
        }
    }
}

// Opacity alone gives what RGBA in a fixed ratio gives.
TEST(Warp, OneChannelIsOpacityTimesColour) {
    const auto opacity = [](int x, int y) { return float((x * x + 3 * y) % 17) / 17; };
    const OwnedRaster all({-2, 5}, {50, 40}, opacity);
    std::vector<float> values;
    for (std::size_t i = 0; i < all.rgba.size(); i += 4) values.push_back(all.rgba[i]);
    const Raster one{all.min, all.size, values.data(), 1, {0.5f, 2.0f, 0.0f}};
    for (const double scale : {0.6, 2.5, 3.8}) {
        Image expected({90, 70});
        Image picture({90, 70});
        warp(all.raster(), affine(scale, 0.1, -2, -0.2, 0.7, 4), WarpFilter::kSharp, expected);
        warp(one, affine(scale, 0.1, -2, -0.2, 0.7, 4), WarpFilter::kSharp, picture);
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
            const float a = expected.rgba[i + 3];
            EXPECT_NEAR(picture.rgba[i], 0.5f * a, 1e-6);
            EXPECT_NEAR(picture.rgba[i + 1], 2 * a, 2e-6);
            EXPECT_EQ(picture.rgba[i + 2], 0);
            EXPECT_NEAR(picture.rgba[i + 3], a, 1e-6);
        }
    }
}

// What is passed over because it is empty is empty.
TEST(Warp, FindsASinglePixelWherever) {
    int hits = 0;
    for (const int place : {0, 7, 8, 31, 63}) {
        const OwnedRaster raster({0, 0}, {64, 64}, [&](int x, int y) {
            return x == place && y == 63 - place ? 1.0f : 0.0f;
        });
        for (const auto& map : {affine(0.5, 0, 0, 0, 0.5, 0), affine(0, 0.4, 3, -0.4, 0, 60),
                                affine(3, 1, -60, -1, 3, -20)}) {
            Image picture = usedPicture({150, 150});
            warp(raster.raster(), map, WarpFilter::kSharp, picture);
            double sum = 0;
            bool hit = false;  // a pixel's centre lies close to the raster's
            for (int y = 0; y < 150; ++y) {
                for (int x = 0; x < 150; ++x) {
                    const glm::dvec3 p = map * glm::dvec3(x + 0.5, y + 0.5, 1);
                    const double reach = 2 * std::max(1.0, std::hypot(map[0].x, map[1].x));
                    const bool near =
                        std::abs(p.x - place) < reach && std::abs(p.y - (63 - place)) < reach;
                    const float value = picture.pixel(x, y)[3];
                    if (!near) {
                        ASSERT_EQ(value, 0);
                    }
                    sum += value;
                    hit = hit || std::hypot(p.x - place, p.y - (63 - place)) < 0.5;
                }
            }
            if (hit) {
                EXPECT_GT(sum, 0.05) << place;
            }
            hits += hit;
        }
    }
    EXPECT_GT(hits, 8);
}

TEST(Warp, EmptyRasterIsTransparent) {
    Image picture = usedPicture({3, 2});
    warp({}, glm::dmat3(1), WarpFilter::kSharp, picture);
    for (const float value : picture.rgba) EXPECT_EQ(value, 0.0f);
}

TEST(Warp, SameBitsOnEveryNumberOfThreads) {
    const OwnedRaster raster({0, 0}, {300, 250},
                             [](int x, int y) { return float((x * x + 3 * y) % 17) / 17; });
    for (const double step : {0.6, 4.0, 7.0}) {
        const glm::dmat3 map = affine(step, 0.1, -2, -0.2, 0.7 * step, 4);
        const auto warped = [&](int threads) {
            const ThreadLimit limit(threads);
            Image picture({90, 70});
            warp(raster.raster(), map, WarpFilter::kSharp, picture);
            return picture.rgba;
        };
        EXPECT_EQ(warped(1), warped(2)) << step;
    }
}

// Values that are no opacity come back as they are, in all four channels.
TEST(Warp, ValuesKeepTheirRange) {
    std::vector<float> values(30 * 30);
    for (int i = 0; i < 900; ++i) values[i] = i % 30 < 15 ? -4.0f : 900.0f;
    const Raster raster{{0, 0}, {30, 30}, values.data(), 1};
    for (const WarpFilter filter : kFilters) {
        // The last columns and rows lie at the raster's edge and beyond.
        Image picture({120, 120});
        warp(raster, affine(0.3, 0, -0.1, 0, 0.3, -0.1), filter, picture);
        float low = 0;
        float high = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
            for (int c = 1; c < 4; ++c) ASSERT_EQ(picture.rgba[i + c], picture.rgba[i]);
            low = std::min(low, picture.rgba[i]);
            high = std::max(high, picture.rgba[i]);
        }
        EXPECT_NEAR(low, -4, 1e-5);
        EXPECT_NEAR(high, 900, 1e-3);
    }
}

}  // namespace
}  // namespace deltasplat
