// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace deltasplat {

struct CameraMotion;
struct ColorOptions;
struct DenseSource;
struct DepthImage;
struct Environment;
class HelperProcess;
struct Image;
struct ImageFileOptions;
struct Listener;
struct ReadOptions;

/// What ColorTransform does.
class ColorProcessor {
  public:
    virtual ~ColorProcessor() = default;
    virtual void convert(Image& image) const = 0;
    virtual void show(Image& image) const = 0;
};

/// All that is done by OpenImageIO, which takes longer to load than most commands take: the program
/// loads it when one of these is first called. Each is what the function of the library does that
/// has its name, after that has checked what it was given.
struct ImageModule {
    /// Of .tif and .jpg alone.
    std::string (*encodeImage)(const std::filesystem::path& file, const Image& image,
                               const ImageFileOptions& options);
    /// @param helper  at work on textOf(options), if they ask for anything
    std::unique_ptr<ColorProcessor> (*makeColorProcessor)(const ColorOptions& options,
                                                          HelperProcess& helper);
    bool (*isWholeImage)(const std::filesystem::path& file);
    Image (*readThumbnail)(const std::filesystem::path& file, int mostSide);
    std::string (*encodeThumbnail)(const Image& image);
    DepthImage (*readDepthImage)(const std::filesystem::path& file, const Listener& listener);
    Environment (*readEnvironment)(const std::filesystem::path& file, const Listener& listener);
    CameraMotion (*readExrCamera)(const std::filesystem::path& file, const Listener& listener);
    DenseSource (*openImages)(const std::filesystem::path& input, const std::string& name,
                              const std::vector<std::filesystem::path>& files,
                              const ReadOptions& options, const Listener& listener);
};

/// Returns the module: linked to the library (linked_image_module.cpp), or what the program loads
/// (tools/modules/).
/// @throw Error(kFailed) if it cannot be loaded
const ImageModule& imageModule();

/// ColorOptions as what the helper is asked for, and back.
std::string textOf(const ColorOptions& options);
ColorOptions colorOptionsOf(const std::string& text);

/// What the module is made of.
namespace image_module {

std::string encodeImage(const std::filesystem::path& file, const Image& image,
                        const ImageFileOptions& options);
std::unique_ptr<ColorProcessor> makeColorProcessor(const ColorOptions& options,
                                                   HelperProcess& helper);
bool isWholeImage(const std::filesystem::path& file);
Image readThumbnail(const std::filesystem::path& file, int mostSide);
std::string encodeThumbnail(const Image& image);
DepthImage readDepthImage(const std::filesystem::path& file, const Listener& listener);
Environment readEnvironment(const std::filesystem::path& file, const Listener& listener);
CameraMotion readExrCamera(const std::filesystem::path& file, const Listener& listener);
DenseSource openImages(const std::filesystem::path& input, const std::string& name,
                       const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                       const Listener& listener);

inline constexpr ImageModule kModule{encodeImage,     makeColorProcessor, isWholeImage,
                                     readThumbnail,   encodeThumbnail,    readDepthImage,
                                     readEnvironment, readExrCamera,      openImages};

}  // namespace image_module

}  // namespace deltasplat
