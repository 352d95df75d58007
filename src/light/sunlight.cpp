// SPDX-License-Identifier: Apache-2.0
// Based on: A. J. Preetham, Peter Shirley and Brian Smits, "A Practical Analytic Model for
// Daylight", 1999, appendix 1, "Transmittance expressions for atmospheric constituents", after
// Muhammad Iqbal, "An Introduction to Solar Radiation", 1983 (Rayleigh, Angstrom's aerosol,
// Leckner's ozone, Kasten's air mass) and its table 2 (the sun's spectrum, ozone). Water vapour and
// mixed gases, which absorb from 690 nm on, are left out. The observer is that of Chris Wyman,
// Peter-Pike Sloan and Peter Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
// Functions", 2013 (multi-lobe).
#include "light/sunlight.h"

#include <array>
#include <glm/common.hpp>
#include <numbers>

#include "optics/color_space.h"
#include "portable_math.h"

namespace deltasplat {
namespace {

struct Wavelength {
    double sun;    // radiance, in any unit
    double ozone;  // absorption by a centimetre
};

// From 380 to 750 nm.
constexpr double kFirstNanometres = 380;
constexpr double kStepNanometres = 10;
constexpr std::array<Wavelength, 38> kSpectrum{
    {{165.5, 0},     {162.3, 0},     {211.2, 0},     {258.8, 0},     {258.2, 0},     {242.3, 0},
     {267.6, 0},     {296.6, 0.003}, {305.4, 0.006}, {300.6, 0.009}, {306.6, 0.014}, {288.3, 0.021},
     {287.1, 0.03},  {278.2, 0.04},  {271.0, 0.048}, {272.3, 0.063}, {263.6, 0.075}, {255.0, 0.085},
     {250.6, 0.103}, {253.1, 0.12},  {253.5, 0.12},  {251.3, 0.115}, {246.3, 0.125}, {241.7, 0.12},
     {236.8, 0.105}, {232.1, 0.09},  {228.2, 0.079}, {223.4, 0.067}, {219.7, 0.057}, {215.3, 0.048},
     {211.0, 0.036}, {207.3, 0.028}, {202.4, 0.023}, {198.7, 0.018}, {194.3, 0.014}, {190.7, 0.011},
     {186.3, 0.01},  {182.6, 0.009}}};

// A bell curve that is steeper on one side.
double lobe(double nanometres, double middle, double before, double behind) {
    const double away = (nanometres - middle) / (nanometres < middle ? before : behind);
    return portable::exp(-0.5 * away * away);
}

glm::dvec3 observerAt(double nanometres) {
    return {
        1.056 * lobe(nanometres, 599.8, 37.9, 31.0) + 0.362 * lobe(nanometres, 442.0, 16.0, 26.7) -
            0.065 * lobe(nanometres, 501.1, 20.4, 26.2),
        0.821 * lobe(nanometres, 568.8, 46.9, 40.5) + 0.286 * lobe(nanometres, 530.9, 16.3, 31.1),
        1.217 * lobe(nanometres, 437.0, 11.8, 36.0) + 0.681 * lobe(nanometres, 459.0, 26.0, 13.8)};
}

// Of the air above, straight up is 1.
double airMass(double zenithAngle) {
    const double degrees = zenithAngle * (180 / std::numbers::pi);
    return 1 / (portable::cos(zenithAngle) + 0.15 * portable::pow(93.885 - degrees, -1.253));
}

double depthOfAir(double micrometres, const Wavelength& wavelength, double turbidity) {
    constexpr double kOzoneCentimetres = 0.35;
    const double aerosol = 0.04608 * turbidity - 0.04586;
    return 0.008735 * portable::pow(micrometres, -4.08) +
           aerosol * portable::pow(micrometres, -1.3) + kOzoneCentimetres * wavelength.ozone;
}

// XYZ of what is left of the sun's light.
glm::dvec3 sunXyz(double mass, double turbidity) {
    glm::dvec3 xyz(0);
    for (std::size_t i = 0; i < kSpectrum.size(); ++i) {
        const double nanometres = kFirstNanometres + kStepNanometres * double(i);
        const double depth = depthOfAir(nanometres / 1000, kSpectrum[i], turbidity);
        xyz += kSpectrum[i].sun * portable::exp(-mass * depth) * observerAt(nanometres);
    }
    return xyz;
}

const glm::dvec3& aboveAir() {
    static const glm::dvec3 xyz = sunXyz(0, 0);
    return xyz;
}

}  // namespace

glm::dvec3 colorUnderSun(const glm::dvec3& xyz) {
    const glm::dvec3 share = xyz / (aboveAir() / aboveAir().y);
    return glm::max(linearFromShareOfWhite(share), glm::dvec3(0));
}

glm::dvec3 sunColor(double zenithAngle, double turbidity) {
    return colorUnderSun(sunXyz(airMass(zenithAngle), turbidity) / aboveAir().y);
}

}  // namespace deltasplat
