// SPDX-License-Identifier: Apache-2.0
// Headers by GDCM, pixels by ITK's class for DICOM, which applies rescale slope and intercept.
#include <gdcmAttribute.h>
#include <gdcmImageHelper.h>
#include <gdcmReader.h>
#include <gdcmRescaler.h>
#include <itkGDCMImageIO.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "deltasplat/error.h"
#include "ingest/dense_source.h"
#include "ingest/dicom_slices.h"
#include "ingest/file_name.h"
#include "ingest/itk_calls.h"
#include "ingest/itk_types.h"
#include "ingest/readers.h"
#include "ingest/rescale.h"
#include "memory.h"
#include "printable.h"

namespace deltasplat {
namespace {

constexpr bool kBigEndian = std::endian::native == std::endian::big;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(file.string(), got, expected));
}

// The values of one attribute; none if the file does not have it.
template <std::uint16_t kGroup, std::uint16_t kElement>
auto valuesOf(const gdcm::File& file) {
    using Attribute = gdcm::Attribute<kGroup, kElement>;
    std::vector<typename Attribute::ArrayType> values;
    const gdcm::DataSet& set = file.GetDataSet();
    if (!set.FindDataElement(Attribute::GetTag()) ||
        set.GetDataElement(Attribute::GetTag()).IsEmpty()) {
        return values;
    }
    Attribute attribute;
    attribute.SetFromDataSet(set);
    const auto* first = attribute.GetValues();
    values.assign(first, first + attribute.GetNumberOfValues());
    return values;
}

template <std::uint16_t kGroup, std::uint16_t kElement, std::size_t kCount>
std::array<double, kCount> numbersOf(const std::filesystem::path& path, const gdcm::File& file,
                                     const char* name) {
    const auto values = valuesOf<kGroup, kElement>(file);
    std::array<double, kCount> numbers{};
    bool finite = values.size() == kCount;
    for (std::size_t i = 0; finite && i < kCount; ++i) {
        numbers[i] = double(values[i]);
        finite = std::isfinite(numbers[i]) && std::abs(numbers[i]) < 1e9;
    }
    if (!finite) {
        refuse(path, std::string("no usable ") + name,
               std::to_string(kCount) + " numbers that say where the slice lies");
    }
    return numbers;
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
    const auto photometric = gdcm::ImageHelper::GetPhotometricInterpretationValue(file);
    if (format.GetSamplesPerPixel() != 1 ||
        photometric == gdcm::PhotometricInterpretation::PALETTE_COLOR) {
        refuse(path, "a colour image", "one value a pixel");
    }
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

void setPlace(const gdcm::File& file, DicomSlice& slice) {
    const auto at = numbersOf<0x20, 0x32, 3>(slice.file, file, "ImagePositionPatient");
    const auto axes = numbersOf<0x20, 0x37, 6>(slice.file, file, "ImageOrientationPatient");
    const auto pixel = numbersOf<0x28, 0x30, 2>(slice.file, file, "PixelSpacing");
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
    for (const auto& sizes : {valuesOf<0x18, 0x88>(file), valuesOf<0x18, 0x50>(file)}) {
        if (sizes.empty() || !std::isfinite(sizes[0]) || !(sizes[0] > 0)) continue;
        slice.thickness = sizes[0];
        break;
    }
}

void setSize(const gdcm::File& file, DicomSlice& slice) {
    const auto columns = valuesOf<0x28, 0x11>(file);
    const auto rows = valuesOf<0x28, 0x10>(file);
    if (columns.empty() || rows.empty() || columns[0] == 0 || rows[0] == 0) {
        refuse(slice.file, "no image", "a DICOM slice with rows and columns");
    }
    const auto frames = valuesOf<0x28, 0x08>(file);
    if (!frames.empty() && frames[0] != 1) {
        refuse(slice.file, std::to_string(int(frames[0])) + " frames in one file",
               "one slice in each file");
    }
    slice.columns = columns[0];
    slice.rows = rows[0];
    slice.type = typeOf(slice.file, file);
    const gdcm::TransferSyntax& syntax = file.GetHeader().GetDataSetTransferSyntax();
    const bool packed =
        syntax.IsEncapsulated() || syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian;
    const double bits = gdcm::ImageHelper::GetPixelFormatValue(file).GetBitsAllocated();
    const double claimed = double(slice.columns) * slice.rows * bits / 8;
    const double held = double(std::filesystem::file_size(slice.file));
    // Lossless JPEG 2000 of one grey packs best; this much is beyond anything an image is.
    if (claimed <= (packed ? 65536 * held : held)) return;
    refuse(slice.file, std::to_string(std::uint64_t(held)) + " bytes",
           "enough for " + std::to_string(slice.columns) + "x" + std::to_string(slice.rows) +
               " pixels");
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
    callItk(slice.file, [&] {
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
    DicomSlice slice;
    slice.file = path;
    callItk(path, [&] {
        gdcm::ImageHelper::SetForceRescaleInterceptSlope(true);
        gdcm::Reader reader;
        reader.SetFileName(path.c_str());
        if (!reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010))) {
            refuse(path, "what GDCM refuses", "a DICOM file");
        }
        const gdcm::File& file = reader.GetFile();
        const auto series = valuesOf<0x20, 0x0e>(file);
        if (!series.empty()) slice.series = std::string(series[0]);
        setSize(file, slice);
        setPlace(file, slice);
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
    source.space = "LPS";
    source.forEachLayer = [files](const DenseSource::LayerUse& use, const Listener& listener) {
        readLayers(*files, use, listener);
    };
    return source;
}

}  // namespace deltasplat
