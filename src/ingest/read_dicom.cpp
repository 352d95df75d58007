// SPDX-License-Identifier: Apache-2.0
// Headers by GDCM, pixels by ITK's class for DICOM, which applies rescale slope and intercept.
#include <gdcmImageHelper.h>
#include <gdcmReader.h>
#include <gdcmRescaler.h>
#include <itkGDCMImageIO.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include "deltasplat/error.h"
#include "ingest/dense_source.h"
#include "ingest/dicom_slices.h"
#include "ingest/dicom_walk.h"
#include "ingest/file_name.h"
#include "ingest/itk_calls.h"
#include "ingest/itk_types.h"
#include "ingest/placement.h"
#include "ingest/readers.h"
#include "ingest/rescale.h"
#include "memory.h"
#include "printable.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kSliceThickness = 0x00180050;
constexpr std::uint32_t kSpacingBetweenSlices = 0x00180088;
constexpr std::uint32_t kSeries = 0x0020000e;
constexpr std::uint32_t kPosition = 0x00200032;
constexpr std::uint32_t kOrientation = 0x00200037;
constexpr std::uint32_t kSamples = 0x00280002;
constexpr std::uint32_t kPhotometric = 0x00280004;
constexpr std::uint32_t kFrames = 0x00280008;
constexpr std::uint32_t kRows = 0x00280010;
constexpr std::uint32_t kColumns = 0x00280011;
constexpr std::uint32_t kPixelSpacing = 0x00280030;
constexpr std::uint32_t kBitsAllocated = 0x00280100;
constexpr std::uint32_t kBitsStored = 0x00280101;
constexpr std::uint32_t kHighBit = 0x00280102;
constexpr std::uint32_t kSign = 0x00280103;

constexpr bool kBigEndian = std::endian::native == std::endian::big;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(file.string(), got, expected));
}

// The numbers of an attribute that is text, "1\0\0"; none if one of them is no usable number.
// GDCM takes what is no number for 0.
std::vector<double> numbersOf(const DicomElements& elements, std::uint32_t tag) {
    std::vector<double> numbers;
    std::istringstream parts(elements.text(tag));
    for (std::string part; std::getline(parts, part, '\\');) {
        part.erase(0, part.find_first_not_of(" +"));
        part.erase(part.find_last_not_of(' ') + 1);
        double number = 0;
        const char* const end = part.data() + part.size();
        const auto result = std::from_chars(part.data(), end, number);
        const bool whole = result.ec == std::errc{} && result.ptr == end;
        if (!whole || !std::isfinite(number) || std::abs(number) > 1e9) return {};
        numbers.push_back(number);
    }
    return numbers;
}

std::vector<double> placeOf(const std::filesystem::path& path, const DicomElements& elements,
                            std::uint32_t tag, const char* name, std::size_t count) {
    std::vector<double> numbers = numbersOf(elements, tag);
    if (numbers.size() == count) return numbers;
    refuse(path, std::string("no usable ") + name,
           std::to_string(count) + " numbers that say where the slice lies");
}

std::optional<RawType> rawTypeOf(gdcm::PixelFormat::ScalarType type) {
    switch (type) {
        case gdcm::PixelFormat::UINT8:
            return RawType::kUint8;
        case gdcm::PixelFormat::INT8:
            return RawType::kInt8;
        case gdcm::PixelFormat::UINT12:
        case gdcm::PixelFormat::UINT16:
            return RawType::kUint16;
        case gdcm::PixelFormat::INT12:
        case gdcm::PixelFormat::INT16:
            return RawType::kInt16;
        case gdcm::PixelFormat::UINT32:
            return RawType::kUint32;
        case gdcm::PixelFormat::INT32:
            return RawType::kInt32;
        case gdcm::PixelFormat::FLOAT32:
            return RawType::kFloat32;
        case gdcm::PixelFormat::FLOAT64:
            return RawType::kFloat64;
        default:
            return std::nullopt;
    }
}

RawType typeOf(const std::filesystem::path& path, const gdcm::File& file) {
    const gdcm::PixelFormat format = gdcm::ImageHelper::GetPixelFormatValue(file);
    const std::vector<double> rescale = gdcm::ImageHelper::GetRescaleInterceptSlopeValue(file);
    gdcm::Rescaler rescaler;
    rescaler.SetIntercept(rescale.at(0));
    rescaler.SetSlope(rescale.at(1));
    rescaler.SetPixelFormat(format);
    const std::optional<RawType> type = rawTypeOf(rescaler.ComputeInterceptSlopePixelType());
    if (!type || !std::isfinite(rescale[0]) || !std::isfinite(rescale[1])) {
        refuse(path, "pixels of an unknown type", "whole or real numbers");
    }
    return *type;
}

void setPlace(const DicomElements& elements, DicomSlice& slice) {
    const auto at = placeOf(slice.file, elements, kPosition, "ImagePositionPatient", 3);
    const auto axes = placeOf(slice.file, elements, kOrientation, "ImageOrientationPatient", 6);
    const auto pixel = placeOf(slice.file, elements, kPixelSpacing, "PixelSpacing", 2);
    const glm::dvec3 row(axes[0], axes[1], axes[2]);
    const glm::dvec3 column(axes[3], axes[4], axes[5]);
    const bool square = std::abs(glm::length(row) - 1) < 1e-2 &&
                        std::abs(glm::length(column) - 1) < 1e-2 &&
                        std::abs(glm::dot(row, column)) < 1e-2;
    if (!square || !(pixel[0] > 0) || !(pixel[1] > 0)) {
        refuse(slice.file, "directions or spacing that are impossible",
               "unit vectors at a right angle and spacing above 0");
    }
    slice.position = {at[0], at[1], at[2]};
    // The spacing's first number is from row to row.
    slice.alongRow = glm::normalize(row) * pixel[1];
    slice.alongColumn = glm::normalize(column) * pixel[0];
    for (const std::uint32_t tag : {kSpacingBetweenSlices, kSliceThickness}) {
        const std::vector<double> sizes = numbersOf(elements, tag);
        if (sizes.empty() || !(sizes[0] > 0)) continue;
        slice.thickness = sizes[0];
        break;
    }
}

void setSize(const DicomElements& elements, DicomSlice& slice) {
    slice.columns = elements.number(kColumns, 0);
    slice.rows = elements.number(kRows, 0);
    if (slice.columns < 1 || slice.rows < 1) {
        refuse(slice.file, "no image", "a DICOM slice with rows and columns");
    }
    const std::string colors = elements.text(kPhotometric);
    if (elements.number(kSamples, 1) != 1 || (colors != "MONOCHROME1" && colors != "MONOCHROME2")) {
        refuse(slice.file, "pixels of kind " + (colors.empty() ? "unknown" : printable(colors)),
               "one grey value a pixel");
    }
    const std::string frames = elements.text(kFrames);
    if (!frames.empty() && frames != "1") {
        refuse(slice.file, printable(frames) + " frames in one file", "one slice in each file");
    }
    const int bits = elements.number(kBitsAllocated, 0);
    const int stored = elements.number(kBitsStored, 0);
    const int high = elements.number(kHighBit, 0);
    const int sign = elements.number(kSign, 0);
    if ((bits != 8 && bits != 16 && bits != 32) || stored < 1 || stored > bits ||
        high != stored - 1 || sign > 1) {
        refuse(slice.file,
               "pixels of " + std::to_string(stored) + " bits up to bit " + std::to_string(high) +
                   " in " + std::to_string(bits),
               "whole numbers of 8, 16 or 32 bits");
    }
}

void requirePixels(const DicomElements& elements, const DicomSlice& slice) {
    const double bytes =
        double(slice.columns) * slice.rows * elements.number(kBitsAllocated, 0) / 8;
    // Lossless JPEG 2000 of one grey packs best; this much is beyond anything an image is.
    const double most = double(elements.pixelBytes) * (elements.packed ? 65536 : 1);
    if (bytes <= most) return;
    refuse(slice.file, std::to_string(elements.pixelBytes) + " bytes of pixels",
           "enough for " + std::to_string(slice.columns) + "x" + std::to_string(slice.rows));
}

// The slices as ITK reads them, in values of one type.
struct DicomFiles {
    DicomVolume volume;
    RawType type = RawType::kUint8;

    std::size_t slicePixels() const {
        return std::size_t(volume.slices[0].columns) * std::size_t(volume.slices[0].rows);
    }
};

void readPixels(const DicomFiles& files, const DicomSlice& slice, std::byte* to) {
    callItk(slice.file, Printed::kIsNothing, [&] {
        auto io = itk::GDCMImageIO::New();
        io->SetFileName(slice.file.string());
        io->ReadImageInformation();
        const std::optional<RawType> type = rawTypeOfItk(io->GetComponentType());
        if (io->GetDimensions(0) != std::size_t(slice.columns) ||
            io->GetDimensions(1) != std::size_t(slice.rows) || io->GetNumberOfComponents() != 1 ||
            std::size_t(io->GetImageSizeInPixels()) != files.slicePixels() || type != slice.type) {
            refuse(slice.file, "pixels of another size or type than its header names",
                   "a slice that GDCM reads alike");
        }
        if (slice.type == files.type) {
            io->Read(to);
            return;
        }
        std::vector<std::byte> own(files.slicePixels() * std::size_t(rawTypeBytes(slice.type)));
        io->Read(own.data());
        rescaleValues(own.data(), files.slicePixels(), slice.type, kBigEndian, {}, files.type, to);
    });
}

void readLayers(const DicomFiles& files, const DenseSource::LayerUse& use,
                const Listener& listener) {
    const int slices = int(files.volume.slices.size());
    const std::size_t sliceBytes = files.slicePixels() * std::size_t(rawTypeBytes(files.type));
    const int most = std::min(slices, DenseSource::kLayerSlices);
    const auto bytes = std::make_unique_for_overwrite<std::byte[]>(sliceBytes * std::size_t(most));
    for (int first = 0; first < slices; first += DenseSource::kLayerSlices) {
        const int count = std::min(DenseSource::kLayerSlices, slices - first);
        for (int i = 0; i < count; ++i) {
            readPixels(files, files.volume.slices[std::size_t(first + i)],
                       bytes.get() + sliceBytes * std::size_t(i));
        }
        use(first, count, bytes.get());
        listener.report(double(first + count) / slices);
    }
}

// Slices of different types, as when each has a slope of its own, meet in float64.
RawType commonType(const std::vector<DicomSlice>& slices) {
    const bool same = std::all_of(slices.begin(), slices.end(), [&](const DicomSlice& slice) {
        return slice.type == slices.front().type;
    });
    return same ? slices.front().type : RawType::kFloat64;
}

}  // namespace

DicomSlice readDicomSlice(const std::filesystem::path& path) {
    requireRegularFile(path);
    const DicomElements elements = walkDicom(path);
    DicomSlice slice;
    slice.file = path;
    slice.series = elements.text(kSeries);
    setSize(elements, slice);
    requirePixels(elements, slice);
    setPlace(elements, slice);
    callItk(path, Printed::kIsNothing, [&] {
        gdcm::ImageHelper::SetForceRescaleInterceptSlope(true);
        gdcm::Reader reader;
        reader.SetFileName(path.c_str());
        if (!reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010))) {
            refuse(path, "what GDCM refuses", "a DICOM file");
        }
        slice.type = typeOf(path, reader.GetFile());
    });
    return slice;
}

DenseSource openDicom(const std::filesystem::path& input, const std::string& name,
                      const std::vector<std::filesystem::path>& paths) {
    std::vector<DicomSlice> slices;
    for (const std::filesystem::path& path : paths) slices.push_back(readDicomSlice(path));
    auto files = std::make_shared<DicomFiles>();
    files->type = commonType(slices);
    files->volume = arrangeSlices(input.string(), std::move(slices));

    DenseSource source;
    source.where = input.string();
    source.name = name;
    source.dims = {files->volume.slices[0].columns, files->volume.slices[0].rows,
                   std::int64_t(files->volume.slices.size())};
    source.type = files->type;
    source.bigEndian = kBigEndian;
    source.worldFromIndex = files->volume.worldFromIndex;
    requirePlacement(source.where, "places of slices", source.worldFromIndex);
    source.space = "LPS";
    source.forEachLayer = [files](const DenseSource::LayerUse& use, const Listener& listener) {
        readLayers(*files, use, listener);
    };
    return source;
}

}  // namespace deltasplat
