// SPDX-License-Identifier: BSD-3-Clause
// Colors of vehicles and estimates, as in films and plots: the table of sim/base/vehicle_colors.hpp.

/** For most color-blind people too (after Okabe and Ito 2008). */
export const VEHICLE_COLORS = ['#56b4e9', '#e69f00', '#009e73', '#d55e00', '#cc79a7', '#0072b2', '#a6761d', '#8c6bb1'];
export const ESTIMATE_COLOR = '#f0e442';
