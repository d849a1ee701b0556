// The eight impact tests of Chung & Ooi, Benchmark tests for verifying discrete element modelling codes at particle
// impact level, Granular Matter 13:643–656 (2011), doi:10.1007/s10035-011-0277-0.
//
// The curves are points read off the paper's figures, thinned. They were published with the verification data of Kratos
// Multiphysics (DEMApplication, basic_benchmarks/paper_data). If a figure shows two materials on one curve, one is
// kept.
#pragma once

#include "tests/terrain/verification/impact.hpp"

namespace furrow::verification::chung_ooi {

struct Point {
  double x, y;
};

inline constexpr const char* kSource = "Chung & Ooi 2011 doi:10.1007/s10035-011-0277-0";

// Materials: Young's modulus (Pa), Poisson's ratio, and density (kg/m³) in the comments.
inline constexpr Elastic kGlass{4.8e10, 0.20}, kLimestone{2.0e10, 0.25};          // 2800, 2500: test 1
inline constexpr Elastic kAluminium2{7.0e10, 0.30}, kMagnesium{4.0e10, 0.35};     // 2699, 1800: test 2
inline constexpr Elastic kAluminiumOxide{3.8e11, 0.23}, kCastIron{1.0e11, 0.25};  // 4000, 7000: tests 3, 4
inline constexpr Elastic kAluminium{7.0e10, 0.33};                                // 2700: tests 4, 6, 7, 8
inline constexpr Elastic kSteel{2.08e11, 0.30}, kPolyethylene{1.0e9, 0.40};       // 7850, 1400: test 5
inline constexpr Elastic kNylon{2.5e9, 0.40};                                     // 1000: test 6
inline constexpr Elastic kCopper{1.2e11, 0.35};                                   // 8900: test 7

// Test 1, glass: normal displacement (µm), normal force (kN).
inline constexpr Point kTest1Force[] = {{29.05, 0.4503}, {73.81, 1.508},  {109.05, 2.702}, {148.10, 4.233},
                                        {186.19, 5.966}, {217.14, 7.520}, {251.43, 9.366}, {265.24, 10.176}};
// Test 2, aluminium alloy: time (µs), normal force (kN); and normal displacement (µm), normal force (kN).
inline constexpr Point kTest2History[] = {{84.85, 2.212},   {169.57, 5.894},  {246.61, 9.100},
                                          {318.92, 10.997}, {373.00, 11.357}, {427.16, 10.722},
                                          {501.73, 8.460},  {579.30, 5.091},  {644.26, 2.332}};
// Test 4: angle of incidence (degrees), tangential restitution; spin after (rad/s); rebound angle of the contact patch
// (degrees). Aluminium oxide, and aluminium alloy if the two differ.
inline constexpr Point kTest4Restitution[] = {{10.158, 0.6870}, {14.990, 0.6244}, {20.059, 0.6161}, {25.050, 0.6343},
                                              {30.119, 0.6837}, {35.030, 0.7372}, {40.020, 0.7809}, {50.000, 0.8451},
                                              {59.980, 0.8929}, {69.960, 0.9316}, {80.020, 0.9662}, {85.010, 0.9827}};
inline constexpr Point kTest4RestitutionAlloy[] = {
    {10.000, 0.6713}, {15.069, 0.6129}, {20.059, 0.6087}, {24.970, 0.6334}, {30.040, 0.6829}, {35.030, 0.7364},
    {40.020, 0.7801}, {49.921, 0.8443}, {59.980, 0.8913}, {70.040, 0.9325}, {80.099, 0.9662}, {84.931, 0.9827}};
inline constexpr Point kTest4Spin[] = {{4.951, 19.27},  {10.079, 213.0}, {14.970, 377.8}, {19.941, 510.6},
                                       {24.911, 599.4}, {29.961, 616.5}, {34.931, 582.3}, {39.980, 544.8},
                                       {50.000, 457.0}, {60.020, 357.5}, {69.961, 246.2}, {80.059, 126.3},
                                       {85.030, 63.15}};
inline constexpr Point kTest4SpinAlloy[] = {{4.951, 35.32},  {9.921, 223.7},  {14.970, 389.6}, {20.020, 519.1},
                                            {24.911, 599.4}, {30.039, 617.6}, {34.852, 582.3}, {39.980, 544.8},
                                            {50.000, 458.1}, {60.020, 358.6}, {69.961, 245.1}, {80.059, 125.2},
                                            {85.030, 64.22}};
inline constexpr Point kTest4Angle[] = {{4.901, 3.76},   {9.959, -1.56},  {14.935, -5.54}, {19.988, -7.54},
                                        {24.958, -7.54}, {29.922, -3.55}, {34.962, 3.43},  {39.920, 11.57},
                                        {49.834, 29.35}, {59.987, 47.79}, {69.742, 64.58}, {79.822, 78.70},
                                        {84.783, 84.52}};
// Test 5: v_s/(μ v_n) before against v_s'/(μ v_n') after, and against −R ω'/(μ v_n).
inline constexpr Point kTest5Angle[] = {{0.332, -0.280}, {0.671, -0.493}, {1.009, -0.747}, {1.335, -1.000},
                                        {1.662, -1.267}, {2.000, -1.533}, {2.350, -1.813}, {2.991, -2.440},
                                        {3.341, -2.693}, {4.006, -2.787}, {4.997, -2.000}, {6.000, -1.013},
                                        {9.988, 3.013},  {12.961, 6.013}};
inline constexpr Point kTest5AnglePolyethylene[] = {{0.344, -0.293}, {0.671, -0.573}, {0.997, -0.880}, {1.347, -1.120},
                                                    {1.674, -1.440}, {2.012, -1.760}, {2.326, -2.053}, {2.991, -2.680},
                                                    {3.341, -2.947}, {3.994, -2.933}, {4.997, -2.000}, {5.988, -1.000},
                                                    {10.00, 3.000},  {12.961, 6.013}};
inline constexpr Point kTest5Spin[] = {{0.353, -0.430}, {0.682, -0.820}, {0.994, -1.250}, {1.341, -1.664},
                                       {1.688, -2.094}, {2.000, -2.524}, {2.329, -2.978}, {2.988, -3.904},
                                       {3.318, -4.293}, {3.994, -4.837}, {5.000, -5.007}, {6.006, -5.006},
                                       {10.01, -5.004}, {20.00, -4.991}};
inline constexpr Point kTest5SpinPolyethylene[] = {{0.353, -0.438}, {0.682, -0.901}, {0.994, -1.331}, {1.341, -1.761},
                                                   {1.688, -2.216}, {2.017, -2.670}, {2.347, -3.116}, {3.023, -4.050},
                                                   {3.335, -4.456}, {4.012, -4.934}, {5.000, -4.966}, {6.006, -4.958},
                                                   {9.994, -4.963}, {20.00, -4.942}};
// The finite-element results drawn in the same figure.
inline constexpr Point kTest5AngleFiniteElements[] = {
    {0.586, -0.027}, {0.876, -0.080}, {1.190, -0.213}, {1.553, -0.373}, {1.915, -0.627},
    {2.314, -0.947}, {2.785, -1.253}, {3.317, -1.520}, {3.970, -1.720}, {4.755, -1.707},
    {5.758, -1.200}, {7.124, 0.133},  {9.118, 2.147},  {12.961, 6.013}};
// Test 6: 7/2 μ (1 + e) v_n/v_s before against tangential restitution β = −v_s'/v_s of the contact patch; and v_s/v_n
// before against v_s'/v_n' after.
inline constexpr Point kTest6Restitution[] = {
    {0.176, -0.820}, {0.352, -0.633}, {0.551, -0.445}, {0.771, -0.243},  {0.969, -0.028}, {1.189, 0.097},
    {1.454, 0.119},  {1.740, 0.100},  {2.093, 0.058},  {2.489, 0.005},   {2.996, -0.050}, {3.634, -0.100},
    {4.515, -0.140}, {5.749, -0.175}, {7.819, -0.208}, {11.894, -0.258}, {24.009, -0.342}};
inline constexpr Point kTest6RestitutionNylon[] = {
    {0.176, -0.824}, {0.374, -0.638}, {0.573, -0.443}, {0.749, -0.243},  {0.969, -0.026}, {1.189, 0.093},
    {1.454, 0.119},  {1.740, 0.117},  {2.093, 0.095},  {2.511, 0.056},   {2.996, 0.007},  {3.612, -0.056},
    {4.515, -0.120}, {5.771, -0.159}, {7.819, -0.118}, {11.916, -0.113}, {24.009, -0.116}};
inline constexpr Point kTest6Angle[] = {{0.173, 0.062},  {0.363, 0.102},  {0.574, 0.089},  {0.838, -0.031},
                                        {1.001, -0.151}, {1.198, -0.271}, {1.429, -0.351}, {1.734, -0.377},
                                        {2.149, 0.052},  {2.747, 1.272},  {3.733, 3.241},  {5.677, 7.127}};
// Test 8: as test 6, aluminium alloy; the large sphere stiffer (A) or of the same modulus (B).
inline constexpr Point kTest8RestitutionA[] = {
    {0.187, -0.815}, {0.358, -0.626}, {0.551, -0.439}, {0.765, -0.238},  {0.979, -0.017}, {1.214, 0.096},
    {1.492, 0.111},  {1.770, 0.090},  {2.091, 0.058},  {2.519, 0.006},   {2.989, -0.049}, {3.631, -0.103},
    {4.508, -0.139}, {5.770, -0.162}, {7.845, -0.204}, {11.909, -0.248}, {23.973, -0.318}};

}  // namespace furrow::verification::chung_ooi
