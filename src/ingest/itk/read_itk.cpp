// SPDX-License-Identifier: Apache-2.0
// NRRD and MetaImage through ITK's classes for these files, without its images and pipelines. ITK
// takes a header at its word, so what it says is held against the size of the data first.
#include "ingest/itk/itk_compiler.h"

#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <optional>
#include <vector>

#include "deltasplat/error.h"
#include "ingest/dense/dense_source.h"
#include "ingest/files/byte_source.h"
#include "ingest/files/file_name.h"
#include "ingest/files/refuse_file.h"
#include "ingest/itk/data_claim.h"
#include "ingest/itk/itk_calls.h"
#include "ingest/itk/itk_types.h"
#include "ingest/placement.h"
#include "ingest/readers.h"
#include "lower_case.h"
#include "memory.h"
#include "modules/medical_module.h"
#include "printable.h"

namespace deltasplat {
namespace {

std::string sizesText(const std::vector<std::int64_t>& sizes) {
    std::string text;
    for (const std::int64_t size : sizes) text += (text.empty() ? "" : "x") + std::to_string(size);
    return text;
}

// A file that ITK has opened, and which of its axes are the volume's.
struct ItkFile {
    std::filesystem::path path;
    DataClaim claim;
    itk::ImageIOBase::Pointer io;
    std::vector<unsigned> axes;  // at most three; the others are one voxel long
    RawType type = RawType::kUint8;
    std::size_t sliceBytes = 0;
    std::shared_ptr<std::byte[]> whole;  // once it has been read as a whole

    std::int64_t size(std::size_t axis) const {
        return axis < axes.size() ? std::int64_t(io->GetDimensions(axes[axis])) : 1;
    }
    glm::i64vec3 dims() const { return {size(0), size(1), size(2)}; }
    double bytes() const { return double(sliceBytes) * double(size(2)); }
};

void requireOneScalar(const ItkFile& file) {
    if (file.io->GetNumberOfComponents() == 1) return;
    refuseFile(file.path,
               std::to_string(file.io->GetNumberOfComponents()) + " values a voxel (" +
                   itk::ImageIOBase::GetPixelTypeAsString(file.io->GetPixelType()) + ")",
               "one");
}

// Axes of one voxel give way, the last first, until three are left.
void chooseAxes(ItkFile& file) {
    for (unsigned axis = 0; axis < file.io->GetNumberOfDimensions(); ++axis) {
        file.axes.push_back(axis);
    }
    while (file.axes.size() > 3) {
        const auto single = std::find_if(file.axes.rbegin(), file.axes.rend(), [&](unsigned axis) {
            return file.io->GetDimensions(axis) == 1;
        });
        if (single == file.axes.rend()) {
            refuseFile(file.path, "sizes " + sizesText(file.claim.sizes),
                       "one volume of three axes");
        }
        file.axes.erase(std::next(single).base());
    }
}

// What ITK understood has to be what the claim was checked by.
void requireSameSizes(const ItkFile& file) {
    std::vector<std::int64_t> got;
    for (unsigned axis = 0; axis < file.io->GetNumberOfDimensions(); ++axis) {
        got.push_back(std::int64_t(file.io->GetDimensions(axis)));
    }
    // An axis of one value a voxel is none of ITK's.
    std::vector<std::int64_t> claimed = file.claim.sizes;
    std::erase(claimed, 1);
    std::erase(got, 1);
    if (got == claimed) return;
    refuseFile(file.path, "sizes " + sizesText(file.claim.sizes), "sizes that ITK reads alike");
}

// So has the file that MetaIO is going to open.
void requireSameDataFile(const ItkFile& file) {
    auto* const io = dynamic_cast<itk::MetaImageIO*>(file.io.GetPointer());
    if (io == nullptr) return;
    const std::string name = io->GetMetaImagePointer()->ElementDataFileName();
    const bool local = file.claim.dataFile == file.path;
    if (local ? lowerCase(name) == "local" : file.path.parent_path() / name == file.claim.dataFile)
        return;
    refuseFile(file.path, "data in \"" + printable(name) + "\" as ITK reads it",
               "data in \"" + printable(file.claim.dataFile.string()) + "\"");
}

void requireData(const ItkFile& file) {
    constexpr double kMostGzipRatio = 1032;
    const double held = double(file.claim.dataBytes);
    const double values = file.bytes() / rawTypeBytes(file.type);
    const bool gzip = file.claim.encoding == DataClaim::Encoding::kGzip;
    const bool holds =
        file.claim.encoding == DataClaim::Encoding::kText ? (held + 1) / 2 >= values
        : gzip ? (held + 1) * kMostGzipRatio >= file.bytes() + double(file.claim.skippedBytes)
               : held >= file.bytes();
    if (holds) return;
    refuseFile(file.claim.dataFile, std::to_string(file.claim.dataBytes) + " bytes of data",
               (gzip ? "enough gzip for " : "enough for ") + sizesText(file.claim.sizes) + " " +
                   rawTypeName(file.type));
}

// Neither MetaIO nor NrrdIO looks at the end of packed data, where count and checksum are; NrrdIO
// takes what does not begin as gzip for plain.
void requireUnpackedSize(const ItkFile& file, Packing packing) {
    const auto wanted = file.claim.skippedBytes + std::uint64_t(file.bytes());
    ByteSource source(file.claim.dataFile, packing, file.claim.dataStart);
    const std::uint64_t got = source.skip(wanted + 1, [] {});
    if (got == wanted) return;
    refuseFile(file.claim.dataFile,
               (got > wanted ? "more than " : "") + std::to_string(std::min(got, wanted)) +
                   " bytes unpacked",
               std::to_string(wanted) + " (" + sizesText(file.claim.sizes) + " " +
                   rawTypeName(file.type) + ")");
}

glm::dmat4 worldOf(const ItkFile& file) {
    glm::dmat4 matrix(1);
    for (std::size_t column = 0; column < file.axes.size(); ++column) {
        const unsigned axis = file.axes[column];
        const std::vector<double> direction = file.io->GetDirection(axis);
        for (std::size_t row = 0; row < file.axes.size(); ++row) {
            matrix[int(column)][int(row)] = file.io->GetSpacing(axis) * direction[file.axes[row]];
        }
        matrix[3][int(column)] = file.io->GetOrigin(axis);
    }
    // ITK turns RAS and LAS into LPS.
    if (file.claim.space == "RAS" || file.claim.space == "LAS") {
        for (int column = 0; column < 4; ++column) {
            matrix[column].x = -matrix[column].x;
            if (file.claim.space == "RAS") matrix[column].y = -matrix[column].y;
        }
    }
    requirePlacement(file.path.string(), "spacing and directions", matrix);
    return matrix;
}

void readRegion(const ItkFile& file, int firstSlice, int slices, std::byte* to) {
    itk::ImageIORegion region(file.io->GetNumberOfDimensions());
    for (unsigned axis = 0; axis < region.GetImageDimension(); ++axis) {
        region.SetIndex(axis, 0);
        region.SetSize(axis, file.io->GetDimensions(axis));
    }
    if (file.axes.size() == 3) {
        region.SetIndex(file.axes[2], firstSlice);
        region.SetSize(file.axes[2], std::size_t(slices));
    }
    file.io->SetIORegion(region);
    callItk(file.path, Printed::kIsError, [&] { file.io->Read(to); });
}

void readLayers(ItkFile& file, const DenseSource::LayerUse& use, const Listener& listener) {
    const int slices = int(file.size(2));
    const bool inParts =
        file.io->CanStreamRead() && file.claim.encoding == DataClaim::Encoding::kRaw;
    const int most = std::min(slices, DenseSource::kLayerSlices);
    std::shared_ptr<std::byte[]> bytes = file.whole;
    if (!bytes) {
        const int held = inParts ? most : slices;
        requireMemory(file.path.string(), double(file.sliceBytes) * held);
        bytes = std::make_shared<std::byte[]>(file.sliceBytes * std::size_t(held));
        if (!inParts) {
            readRegion(file, 0, slices, bytes.get());
            file.whole = bytes;
        }
    }
    for (int first = 0; first < slices; first += DenseSource::kLayerSlices) {
        const int count = std::min(DenseSource::kLayerSlices, slices - first);
        if (inParts) readRegion(file, first, count, bytes.get());
        use(first, count, bytes.get() + (inParts ? 0 : file.sliceBytes * std::size_t(first)));
        listener.report(double(first + count) / slices);
    }
}

// Reads the header, and checks what can be checked without the data.
void openFile(ItkFile& file) {
    const std::string extension = lowerExtension(file.path);
    const bool nrrd = extension == ".nrrd" || extension == ".nhdr";
    file.claim = nrrd ? claimOfNrrd(file.path) : claimOfMeta(file.path);
    callItk(file.path, Printed::kIsError, [&] {
        if (nrrd) {
            file.io = itk::NrrdImageIO::New();
        } else {
            file.io = itk::MetaImageIO::New();
        }
        file.io->SetFileName(file.path.string());
        file.io->ReadImageInformation();
    });
    requireSameDataFile(file);
    requireOneScalar(file);
    requireSameSizes(file);
    chooseAxes(file);
    const std::optional<RawType> type = rawTypeOfItk(file.io->GetComponentType());
    if (!type) refuseFile(file.path, "values of an unknown type", "whole or real numbers");
    file.type = *type;
    file.sliceBytes =
        std::size_t(file.size(0)) * std::size_t(file.size(1)) * std::size_t(rawTypeBytes(*type));
    requireData(file);
    if (file.claim.encoding == DataClaim::Encoding::kGzip) {
        requireUnpackedSize(file, nrrd ? Packing::kGzip : Packing::kZlib);
    }
}

}  // namespace

DenseSource medical_module::openItk(const std::filesystem::path& path) {
    auto file = std::make_shared<ItkFile>();
    file->path = path;
    openFile(*file);
    DenseSource source;
    source.where = path.string();
    source.name = nameWithoutExtensions(path);
    source.dims = file->dims();
    source.type = file->type;
    source.bigEndian = std::endian::native == std::endian::big;
    source.worldFromIndex = worldOf(*file);
    source.space = file->claim.space == "LAS" ? "" : file->claim.space;
    source.forEachLayer = [file](const DenseSource::LayerUse& use, const Listener& listener) {
        readLayers(*file, use, listener);
    };
    return source;
}

}  // namespace deltasplat
