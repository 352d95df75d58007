// SPDX-License-Identifier: Apache-2.0
// Based on: nifti1.h, NIfTI-1 Data Format, of the NIfTI Data Format Working Group (2003): 348 bytes
// of fields, then 4 for "no extensions". World space is RAS. The placement is written twice: as a
// matrix (sform), and without shear as a quaternion (qform).
#include <algorithm>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "base/bits.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/nifti/read_nifti.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

constexpr std::size_t kHeaderBytes = 348;
constexpr std::size_t kDataStart = 352;
constexpr int kMostVoxels = 32767;
constexpr std::int16_t kScannerCoordinates = 1;

std::int16_t dataType(RawType type) {
    switch (type) {
        case RawType::kUint8:
            return 2;
        case RawType::kInt8:
            return 256;
        case RawType::kUint16:
            return 512;
        case RawType::kInt16:
            return 4;
        case RawType::kUint32:
            return 768;
        case RawType::kInt32:
            return 8;
        case RawType::kUint64:
            return 1280;
        case RawType::kInt64:
            return 1024;
        case RawType::kFloat32:
            return 16;
        case RawType::kFloat64:
            break;
    }
    return 64;
}

class Fields {
  public:
    Fields() : bytes_(kDataStart, '\0') {}
    template <typename T>
    void set(std::size_t place, T value) {
        storeLittle(value, reinterpret_cast<std::byte*>(bytes_.data()) + place);
    }
    void setFloats(std::size_t place, std::initializer_list<double> values) {
        for (const double value : values) {
            set(place, float(value));
            place += sizeof(float);
        }
    }
    void setText(std::size_t place, const std::string& text) {
        std::copy(text.begin(), text.end(), bytes_.begin() + std::ptrdiff_t(place));
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

void setQuaternion(const DenseLayout& layout, Fields& fields) {
    glm::dmat3 rotation = layout.directions();
    const bool mirrored = glm::determinant(rotation) < 0;
    if (mirrored) rotation[2] = -rotation[2];
    glm::dquat turn = glm::normalize(glm::quat_cast(rotation));
    // The real part is not stored; readers take it as not negative.
    if (turn.w < 0) turn = -turn;
    const glm::dvec3 origin = layout.origin();
    fields.set(252, kScannerCoordinates);
    fields.setFloats(76, {mirrored ? -1.0 : 1.0});
    fields.setFloats(256, {turn.x, turn.y, turn.z, origin.x, origin.y, origin.z});
}

void setMatrix(const DenseLayout& layout, Fields& fields) {
    fields.set(254, kScannerCoordinates);
    const glm::dmat4 rows = glm::transpose(layout.worldFromIndex);
    for (int row = 0; row < 3; ++row) {
        fields.setFloats(280 + 16 * std::size_t(row),
                         {rows[row].x, rows[row].y, rows[row].z, rows[row].w});
    }
}

glm::dmat4 asFloats(const glm::dmat4& matrix) {
    return glm::dmat4(glm::mat4(matrix));
}

}  // namespace

void settleNifti(DenseLayout& layout, const std::string& file, WriteNotes& notes) {
    const int most = std::max({layout.dims.x, layout.dims.y, layout.dims.z});
    if (most > kMostVoxels) {
        throw Error(ErrorCode::kFailed, file, dimsText(layout.dims) + " voxels",
                    "at most " + std::to_string(kMostVoxels) +
                        " along each axis in NIfTI (.nrrd has no such limit)");
    }
    if (layout.space.empty()) {
        notes.remark("no patient space is known; NIfTI takes world space for RAS");
    }
    layout.turnTo("RAS");
    layout.turnToMillimetres();
    layout.noteLabels("NIfTI", false, notes);
    const glm::dmat4 written = asFloats(layout.worldFromIndex);
    if (!givesPlaces(written)) {
        throw Error(ErrorCode::kFailed, file, "spacing, directions or origin out of range",
                    "ones that 32-bit floats hold, as NIfTI has them");
    }
    if (written != layout.worldFromIndex) {
        notes.loss("spacing, directions or origin rounded to 32-bit floats, as NIfTI has them");
    }
}

std::string niftiHeader(const DenseLayout& layout, const std::string&) {
    const glm::dvec3 spacing = layout.spacing();
    Fields fields;
    fields.set(0, std::int32_t(kHeaderBytes));
    fields.setText(38, "r");  // older readers expect it
    std::size_t place = 40;
    for (const int dim : {3, layout.dims.x, layout.dims.y, layout.dims.z, 1, 1, 1, 1}) {
        fields.set(place, std::int16_t(dim));
        place += sizeof(std::int16_t);
    }
    constexpr std::int16_t kLabelIntent = 1002;
    if (layout.labels) fields.set(68, kLabelIntent);
    fields.set(70, dataType(layout.type));
    fields.set(72, std::int16_t(8 * rawTypeBytes(layout.type)));
    fields.setFloats(76, {1, spacing.x, spacing.y, spacing.z, 1, 1, 1, 1});
    fields.setFloats(108, {double(kDataStart), 1, 0});  // slope 1, intercept 0
    constexpr auto kMillimetres = std::uint8_t(2);
    if (!layout.lengthUnit.empty()) fields.set(123, kMillimetres);
    fields.setText(148, "deltasplat " DELTASPLAT_VERSION);
    if (layout.isOrthogonal()) setQuaternion(layout, fields);
    setMatrix(layout, fields);
    fields.setText(344, std::string("n+1"));
    return fields.bytes();
}

}  // namespace deltasplat
