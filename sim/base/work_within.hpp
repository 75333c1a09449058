// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace sim {

/// Does what ThreadPool::for_each() does, within work that a pool shares: by the threads of that pool.  Elsewhere the
/// calling thread does it alone.  For large pieces such as images, of which there may be fewer than threads.
void for_each_within(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace sim
