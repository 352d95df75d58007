// SPDX-License-Identifier: Apache-2.0
#include "volume/placement.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <string_view>

#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {

bool givesPlaces(const glm::dmat4& worldFromIndex) {
    constexpr double kLeastVolume = 1e-9;  // of a voxel, relative to the product of its edges
    double edges = 1;
    bool usable = glm::length(glm::dvec3(worldFromIndex[3])) <= kMostLength;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(glm::dvec3(worldFromIndex[axis]));
        usable = usable && length >= 1 / kMostLength && length <= kMostLength;
        edges *= length;
    }
    return usable && std::abs(glm::determinant(glm::dmat3(worldFromIndex))) >= kLeastVolume * edges;
}

glm::dmat4 withThickness(const glm::dmat4& worldFromIndex, const glm::i64vec3& dims,
                         double thickness) {
    glm::dmat4 whole = worldFromIndex;
    for (int axis = 0; axis < 3; ++axis) {
        if (dims[axis] != 1 || glm::length(glm::dvec3(whole[axis])) > 0) continue;
        const glm::dvec3 normal =
            glm::cross(glm::dvec3(whole[(axis + 1) % 3]), glm::dvec3(whole[(axis + 2) % 3]));
        const double length = glm::length(normal);
        if (length > 0) whole[axis] = glm::dvec4(normal / length * thickness, 0);
    }
    return whole;
}

void scaleLengths(glm::dmat4& worldFromIndex, double factor) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) worldFromIndex[column][row] *= factor;
    }
}

void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix) {
    if (givesPlaces(matrix)) return;
    throw Error(ErrorCode::kInput, where, what + " that cannot be inverted",
                "finite numbers that give each voxel a place of its own");
}

namespace {

struct Unit {
    const char* name;  // as in Volume::lengthUnit
    double millimetres;
    std::initializer_list<std::string_view> spellings;  // other names, in lower case
};

// The micro sign is two Unicode characters and one byte of Latin-1. The same goes for the angstrom.
const std::array<Unit, 11>& units() {
    static const std::array<Unit, 11> kUnits{{
        {"km", 1e6, {"kilometer", "kilometers", "kilometre", "kilometres"}},
        {"m", 1e3, {"meter", "meters", "metre", "metres"}},
        {"dm", 1e2, {"decimeter", "decimeters", "decimetre", "decimetres"}},
        {"cm", 10, {"centimeter", "centimeters", "centimetre", "centimetres"}},
        {"mm", 1, {"millimeter", "millimeters", "millimetre", "millimetres"}},
        {"um",
         1e-3,
         {"micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres",
          "\xc2\xb5m", "\xce\xbcm", "\xb5m", "\\u00b5m", "\\u03bcm"}},
        {"nm", 1e-6, {"nanometer", "nanometers", "nanometre", "nanometres"}},
        {"pm", 1e-9, {"picometer", "picometers", "picometre", "picometres"}},
        {"angstrom",
         1e-7,
         {"angstroms", "\xc3\xa5", "\xc3\x85", "\xe2\x84\xab", "\xc5", "\xc3\x85ngstrom"}},
        {"in", 25.4, {"inch", "inches"}},
        {"ft", 304.8, {"foot", "feet"}},
    }};
    return kUnits;
}

}  // namespace

std::string lengthUnitNamed(const std::string& text) {
    const std::string word = lowerCase(text);
    for (const Unit& unit : units()) {
        if (word == unit.name) return unit.name;
        for (const std::string_view spelling : unit.spellings) {
            if (word == spelling) return unit.name;
        }
    }
    return "";
}

double millimetresIn(const std::string& lengthUnit) {
    for (const Unit& unit : units()) {
        if (lengthUnit == unit.name) return unit.millimetres;
    }
    return 0;
}

}  // namespace deltasplat
