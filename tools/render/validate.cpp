// SPDX-License-Identifier: Apache-2.0
#include "render/validate.h"

#include <filesystem>
#include <optional>
#include <string>

#include "camera/camera_options.h"
#include "options/file_and_name.h"
#include "options/input_options.h"
#include "options/transfer_function_option.h"
#include "output_files.h"
#include "render/annotation_options.h"
#include "render/aov_options.h"
#include "render/color_options.h"
#include "render/deep_options.h"
#include "render/exr_options.h"
#include "render/ground_options.h"
#include "render/preview.h"
#include "render/preview_file.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

// The file of FILE:NAME, or what is no file.
std::filesystem::path fileIn(const std::string& option, const std::filesystem::path& given) {
    const std::optional<FileAndName> found = findFileAndName(option, given);
    return found ? found->file : given;
}

// Files that light and colours are read from.
Files lookFiles(const RenderCommand& command) {
    const MediumChoice& medium = command.picture.medium;
    Files files{command.picture.scatter.environment, command.color.config, command.color.look,
                fileIn("--emission-tf", medium.emissionFunction)};
    for (const LayerChoice& layer : medium.layers)
        files.push_back(fileIn("--layer", layer.transferFunction));
    std::erase(files, std::filesystem::path());
    return files;
}

// @param others  files that are read, and other outputs
void checkPreviewName(const RenderCommand& command, const Files& others) {
    if (!command.progressive) return;
    const std::filesystem::path file = previewFile(command.output);
    checkOutput("--progressive", file, others, "those that the command reads or writes");
    requireFreePreview(file);
}

}  // namespace

void validateOptions(const RenderCommand& command) {
    checkDeep(command);
    checkAovs(command);
    checkExr(command);
    checkColors(command);
    checkGround(command);
    checkPreview(command);
    if (!command.isMovieAlone && !command.slabs) imageFormatOf(command.output);
    checkNumbers(command);
    checkCamera(command.picture.render.camera);
    checkAnnotations(command);
}

void validate(const RenderCommand& command) {
    validateOptions(command);
    if (!command.isMovieAlone && !command.slabs) {
        checkImageFile(command.output, command.picture.render.camera.sizePixels, command.image);
    }
    const Files mask = filesRead(filesOfMask(command.picture.parts), {});
    checkOutput("--output", command.output, mask, "the mask");
    checkOutput("--stats", command.stats, mask, "the mask");
    const Files looks = lookFiles(command);
    if (!looks.empty()) {
        const std::string named = "what light and colours are read from";
        checkOutput("--output", command.output, looks, named);
        checkOutput("--movie", command.movie, looks, named);
        checkOutput("--stats", command.stats, looks, named);
    }
    for (const std::filesystem::path& file : {command.scene.file, cameraFile(command.picture)}) {
        if (file.empty()) continue;
        checkOutput("--output", command.output, {file}, "the scene or the camera");
        checkOutput("--stats", command.stats, {file}, "the scene or the camera");
    }
    Files others =
        filesRead({command.input}, parseTransferFunction(command.picture.transferFunction).file);
    checkOutput("--output", command.output, others, "the input and the transfer function");
    checkOutput("--output", command.output, {command.firstPass}, "the first pass");
    others.push_back(command.firstPass);
    checkOutput("--movie", command.movie, others,
                "the input, the transfer function and the first pass");
    others.push_back(command.output);
    checkOutput("--stats", command.stats, others,
                "the input, the transfer function and the picture");
    others.insert(others.end(), mask.begin(), mask.end());
    others.insert(others.end(), looks.begin(), looks.end());
    others.insert(others.end(),
                  {command.stats, command.movie, command.scene.file, cameraFile(command.picture)});
    checkPreviewName(command, others);
}

}  // namespace deltasplat
