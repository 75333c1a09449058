// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace sim {

/// Returns the folder with the `worlds/` and `vehicles/` shipped with this program: `share/shoal` of its installation,
/// or the checkout of its build folder; in a library that another program has loaded, those of the library.  Empty:
/// there is none.
std::string shipped_folder();

/// Returns the folder of this program, where others of its installation or build are; in a library that another program
/// has loaded, such as the module of Python: `bin` above the library, if `shoal` is there.  Empty: there is none.
std::string program_folder();

/// Returns the folder with `worlds/` and `vehicles/` for a program in `folder`, such as `/usr/local/bin` or
/// `checkout/build/release/bin`.
std::string shipped_folder_of(const std::string& folder);

}  // namespace sim
