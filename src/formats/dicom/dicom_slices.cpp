// SPDX-License-Identifier: Apache-2.0
#include "formats/dicom/dicom_slices.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

std::string sizeText(const DicomSlice& slice) {
    return std::to_string(slice.columns) + "x" + std::to_string(slice.rows);
}

void requireAlike(const std::filesystem::path& input, const DicomSlice& first,
                  const DicomSlice& other) {
    if (first.columns != other.columns || first.rows != other.rows) {
        refuseInput(other.file.string(), "a slice of " + sizeText(other),
                    sizeText(first) + ", as in " + first.name(input));
    }
    // A thousandth of a voxel over a thousand voxels is one voxel.
    const double most =
        1e-3 * std::min(glm::length(first.alongRow), glm::length(first.alongColumn));
    if (glm::distance(first.alongRow, other.alongRow) > most ||
        glm::distance(first.alongColumn, other.alongColumn) > most) {
        refuseInput(other.file.string(), "a slice of another direction or pixel spacing",
                    "one parallel to " + first.name(input));
    }
}

// A gap that is far from the usual one is a slice that is missing, or there twice.
void requireEven(const std::filesystem::path& input, const std::vector<DicomSlice>& slices) {
    const glm::dvec3 normal = slices.front().normal();
    std::vector<double> gaps;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        gaps.push_back(glm::dot(slices[i].position - slices[i - 1].position, normal));
        if (gaps.back() < 1e-4 * slices.front().thickness) {
            refuseInput(
                input.string(),
                slices[i - 1].name(input) + " and " + slices[i].name(input) + " at the same place",
                "one slice at each place");
        }
    }
    std::vector<double> sorted = gaps;
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[(sorted.size() - 1) / 2];
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (std::abs(gaps[i] - usual) <= 0.25 * usual) continue;
        refuseInput(input.string(),
                    slices[i].name(input) + " and " + slices[i + 1].name(input) + " " +
                        numberText(gaps[i]) + " mm apart",
                    numberText(usual) + " mm as between the others (a slice may be missing)");
    }
}

void requireStraight(const std::filesystem::path& input, const std::vector<DicomSlice>& slices,
                     const glm::dvec3& step) {
    const DicomSlice& first = slices.front();
    const double most = std::max(glm::length(first.alongRow), glm::length(first.alongColumn));
    const glm::dvec3 normal = first.normal();
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const glm::dvec3 off = slices[i].position - (first.position + double(i) * step);
        const double aside = glm::length(off - normal * glm::dot(off, normal));
        if (aside <= most) continue;
        refuseInput(input.string(),
                    slices[i].name(input) + " " + numberText(aside) + " mm aside of the others",
                    "slices in one row");
    }
}

}  // namespace

glm::dvec3 DicomSlice::normal() const {
    return glm::normalize(glm::cross(alongRow, alongColumn));
}

std::string DicomSlice::name(const std::filesystem::path& input) const {
    const std::string number = frame > 0 ? " frame " + std::to_string(frame) : "";
    for (const std::filesystem::path& folder : {input, input.parent_path()}) {
        const std::filesystem::path below = file.lexically_relative(folder);
        if (!below.empty() && below != "." && *below.begin() != "..")
            return below.string() + number;
    }
    return file.filename().string() + number;
}

DicomVolume arrangeSlices(const std::filesystem::path& input, std::vector<DicomSlice> slices) {
    const glm::dvec3 normal = slices.front().normal();
    // Files of equal place and so equal key are refused below; names make the order certain.
    std::sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
        const double placeA = glm::dot(a.position, normal);
        const double placeB = glm::dot(b.position, normal);
        if (placeA != placeB) return placeA < placeB;
        return std::tie(a.file, a.frame) < std::tie(b.file, b.frame);
    });
    for (const DicomSlice& slice : slices) requireAlike(input, slices.front(), slice);

    const DicomSlice& first = slices.front();
    glm::dvec3 step = normal * first.thickness;
    if (slices.size() > 1) {
        requireEven(input, slices);
        // A tilted gantry shifts each slice against the one before: the volume is sheared.
        step = (slices.back().position - first.position) / double(slices.size() - 1);
        requireStraight(input, slices, step);
    }
    DicomVolume volume;
    volume.worldFromIndex =
        glm::dmat4(glm::dvec4(first.alongRow, 0), glm::dvec4(first.alongColumn, 0),
                   glm::dvec4(step, 0), glm::dvec4(first.position, 1));
    volume.slices = std::move(slices);
    return volume;
}

}  // namespace deltasplat
