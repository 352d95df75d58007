// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "annotate/annotation_choice.h"
#include "camera/camera_choice.h"
#include "deltasplat/image/color_management.h"
#include "deltasplat/image/tone.h"
#include "deltasplat/image/write_image.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"
#include "deltasplat/render_aovs.h"
#include "deltasplat/render_deep.h"
#include "deltasplat/slabs.h"
#include "formats/usd/usd_scene.h"
#include "listener.h"
#include "options/command_line.h"
#include "options/cut_options.h"
#include "options/medium_options.h"
#include "options/scatter_options.h"
#include "options/shading_options.h"
#include "options/surface_options.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// What to make a picture of and how: what all subcommands that render are asked.
struct PictureOptions {
    std::filesystem::path transferFunction;  ///< empty: a ramp
    std::optional<glm::vec4> background;
    ReadOptions read;
    RenderOptions render;
    std::optional<int> join;  ///< most slices that may be drawn as one; empty: kMostJoined
    ShadingChoice shading;
    ScatterChoice scatter;
    MediumChoice medium;
    SurfaceChoice surface;
    CutChoice parts;
    CameraChoice camera;
    glm::dmat4 worldFromInput{1.0};     ///< where a scene has the volume
    std::optional<glm::dvec3> upWorld;  ///< what is up in a scene, unless the camera says
};

/// Most slices that may be drawn as one where a picture is to be as others of the same volume are,
/// by a camera that moves or by other processes.
inline int joinOfMany(const PictureOptions& picture) {
    return picture.join.value_or(SplatOptions().mostJoined);
}

/// Whether what is shown is fog by what was asked for, which has no surfaces.
inline bool isFog(const PictureOptions& picture) {
    return picture.scatter.asked() || picture.medium.asked();
}

/// What files of 8 and 16 bits show of light.
struct ToneChoice {
    double exposureStops = 0;
    Tone tone = Tone::kStandard;
};

/// Channels beside a picture's own.
struct ChannelChoice {
    std::vector<Aov> aovs;
    bool shadow = false;  ///< on the ground, not under the picture

    bool asked() const { return shadow || !aovs.empty(); }
    bool has(Aov aov) const { return std::find(aovs.begin(), aovs.end(), aov) != aovs.end(); }
};

/// How far a picture reaches beyond its frame.
struct OverscanChoice {
    glm::ivec2 pixels{0};
    double percent = 0;  ///< of its width and height, besides

    bool asked() const { return pixels != glm::ivec2(0) || percent > 0; }
    glm::ivec2 of(glm::ivec2 size) const {
        const glm::dvec2 share = glm::ceil(percent / 100 * glm::dvec2(size));
        return pixels + glm::ivec2(glm::min(share, double(kMostOverscan)));
    }
};

/// A plane to throw a shadow on.
struct GroundChoice {
    glm::dvec3 pointWorld{0.0};
    std::optional<glm::dvec3> normalWorld;  ///< empty: what is up
};

/// A scene that says which volume is shown, and where.
struct SceneChoice {
    std::filesystem::path file;  ///< empty: none
    std::optional<UsdVolumeMotion> motion;
    bool isGridGiven = false;  ///< --grid counts, not the scene's field

    bool moves() const { return motion && !motion->frames.empty(); }
};

/// A colour transform that is made when it is first asked for: that takes longer than its use.
struct KeptColors {
    std::once_flag once;
    std::optional<ColorTransform> transform;
};

/// What `deltasplat render` was asked to do.
struct RenderCommand {
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path stats;  ///< empty: none
    PictureOptions picture;
    bool drr = false;                  ///< another way to say mode drr
    std::optional<glm::dvec2> window;  ///< values of black and white; empty: percentiles
    ImageFileOptions image;
    std::optional<PixelBox> region;  ///< of the picture without its overscan; empty: all of it
    OverscanChoice overscan;
    ToneChoice tone;
    ColorOptions color;
    /// What `color` makes, for all copies of the command.
    std::shared_ptr<KeptColors> keptColors = std::make_shared<KeptColors>();
    ChannelChoice channels;
    AovOptions aovOptions;
    std::optional<GroundChoice> ground;  ///< whose shadow is shown; empty: none
    std::filesystem::path holdoutDepth;  ///< of solid things before what is left out; empty: none
    bool deep = false;                   ///< samples with depths instead of a flat picture
    DeepOptions deepOptions;
    std::optional<SlabShare> slabs;  ///< to write in place of a picture
    AnnotationChoice annotations;
    FrameChoice frames;
    SceneChoice scene;
    std::filesystem::path firstPass;         ///< of a sequence; empty: none
    std::string readingOptions;              ///< those given that choose what is read, as typed
    std::optional<int> turntable;            ///< frames of a turn of the camera
    std::optional<glm::ivec2> contactSheet;  ///< columns and rows; empty: none
    bool progressive = false;                ///< whether a small picture comes before
    bool slate = false;                      ///< whether frames have their numbers drawn into them
    std::filesystem::path movie;             ///< empty: none
    bool isMovieAlone = false;               ///< made, then, without pictures besides
    double framesPerSecond = 24;
    std::filesystem::path index;  ///< page of a batch; empty: none
};

/// Declares the options of pixels in a file.
void addStorageOptions(CLI::App& app, ImageFileOptions& image);
void addBackgroundOption(OptionGroup& group, std::optional<glm::vec4>& background);
void addCameraOptions(CLI::App& app, PictureOptions& options);
void addOpticsOptions(CLI::App& app, PictureOptions& options);
/// Declares the options that say which parts of the volume are shown.
void addPartOptions(CLI::App& app, PictureOptions& options);
/// Declares the options of splatting that all methods share.
void addSplattingOptions(CLI::App& app, PictureOptions& options);

/// Declares all options of `deltasplat render`.
void addRenderOptions(CLI::App& app, RenderCommand& command);

/// Gives a panorama the size that it has if none is asked for, and a C-arm its projection.
void applyProjection(const CLI::App& app, CameraOptions& camera);

/// Checks the camera before there is a volume to look at.
/// @throw Error(kUsage) naming the option
void checkCamera(const CameraOptions& camera);

/// Warns of a --view that was given where other options say where a camera on this volume looks.
void warnOfUnusedView(const CLI::App& app, const CameraOptions& options, const Volume& volume,
                      const Listener& listener);

/// Warns of a detector that stands within the volume.
void warnOfDetector(const CameraOptions& options, const Volume& volume, const Listener& listener);

}  // namespace deltasplat
