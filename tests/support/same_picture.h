// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"
#include "support/simd_levels.h"

namespace deltasplat::test {

/// Expects that make(method) returns the same, bit for bit, whatever the method, on however many
/// threads, at every SIMD level; under a sanitizer, which looks at the memory that is touched, by
/// each method once.
template <typename Make>
void expectTheSameHoweverMade(const Make& make) {
    std::optional<ThreadLimit> threads(std::in_place, 1);
    const auto first = make(Method::kAuto);
    for (const Method method : {Method::kTraditional, Method::kSparse, Method::kDelta})
        EXPECT_TRUE(make(method) == first) << methodName(method);
    if (kIsSanitized) return;
    for (const int count : {7, 2}) {
        threads.reset();
        threads.emplace(count);
        EXPECT_TRUE(make(Method::kDelta) == first) << count << " threads";
    }
    for (const std::string& level : testedSimdLevels()) {
        setSimdLevel(level);
        EXPECT_TRUE(make(Method::kDelta) == first) << level;
    }
    setSimdLevel("auto");
}

/// Expects so of a picture.
inline void expectTheSameHoweverItIsMade(const Volume& volume, RenderOptions options) {
    expectTheSameHoweverMade([&](Method method) {
        options.splat.method = method;
        return render(volume, options).image.rgba;
    });
}

/// Expects of a scene prepared once what render() makes, from several sides.
inline void expectPreparedIsTheSame(const std::shared_ptr<const Volume>& volume,
                                    const RenderOptions& options) {
    const PreparedScene scene({volume, options.optics}, options.splat);
    for (const char* view : {"front", "left", "iso"}) {
        RenderOptions one = options;
        one.camera.direction.reset();
        one.camera.view = view;
        const RenderResult expected = render(*volume, one);
        Image image(expected.camera.sizePixels);
        scene.render(expected.camera, image);
        EXPECT_EQ(image.rgba, expected.image.rgba) << view;
    }
}

}  // namespace deltasplat::test
