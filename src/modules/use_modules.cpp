// SPDX-License-Identifier: Apache-2.0
// Functions that a module does, and nothing besides.
#include <utility>

#include "image/thumbnail.h"
#include "modules/image_module.h"
#include "modules/medical_module.h"

namespace deltasplat {

bool isWholeImage(const std::filesystem::path& file) {
    return imageModule().isWholeImage(file);
}

Image readThumbnail(const std::filesystem::path& file, int mostSide) {
    return imageModule().readThumbnail(file, mostSide);
}

std::string encodeThumbnail(const Image& image) {
    return imageModule().encodeThumbnail(image);
}

DepthImage readDepthImage(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readDepthImage(file, listener);
}

Environment readEnvironment(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readEnvironment(file, listener);
}

CameraMotion readExrCamera(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readExrCamera(file, listener);
}

DenseSource openImages(const std::filesystem::path& input, const std::string& name,
                       const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                       const Listener& listener) {
    return imageModule().openImages(input, name, files, options, listener);
}

std::vector<DicomSeries> findSeries(const std::filesystem::path& input,
                                    const std::vector<std::filesystem::path>& files) {
    return medicalModule().findSeries(input, files);
}

DenseSource openDicom(const std::filesystem::path& input, const std::string& name,
                      DicomSeries series) {
    return medicalModule().openDicom(input, name, std::move(series));
}

}  // namespace deltasplat
