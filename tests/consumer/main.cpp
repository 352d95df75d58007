// SPDX-License-Identifier: Apache-2.0
// What a program that uses the library looks like: makes a volume, renders it, looks at a pixel.
#include <deltasplat/image/write_image.h>
#include <deltasplat/ingest/read_volume.h>
#include <deltasplat/optics/transfer_function.h>
#include <deltasplat/prepared_scene.h>
#include <deltasplat/render.h>
#include <deltasplat/synth/write_analytic.h>

#include <cstdio>
#include <memory>

int main() {
    using namespace deltasplat;
    writeAnalytic(makeAnalytic("slab"), "slab_16x16x16_uint8.raw", {glm::ivec3(16)});
    const Volume volume = readVolume("slab_16x16x16_uint8.raw");
    RenderOptions options;
    options.camera.sizePixels = {32, 32};
    // Half of the light of one voxel's depth is taken away, whatever the value.
    options.optics.transferFunction.colors = {{0, glm::dvec3(1)}};
    options.optics.transferFunction.opacities = {{0, 0.5}};
    const RenderResult result = render(volume, options);
    writeImage("slab.exr", result.image, {});

    // The same, prepared for many cameras.
    const auto shared = std::make_shared<const Volume>(volume);
    const PreparedScene scene({shared, options.optics}, options.splat);
    Image image(result.camera.sizePixels);
    scene.render(result.camera, image);
    if (image.rgba != result.image.rgba) return 1;

    const float alpha = result.image.pixel(16, 16)[3];
    std::printf("alpha in the middle: %g\n", alpha);
    return alpha > 0.999F && alpha <= 1.0F ? 0 : 1;
}
