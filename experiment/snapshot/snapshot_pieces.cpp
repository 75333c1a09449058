// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/snapshot_pieces.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "shoal/message_codec.hpp"

namespace experiment {

namespace {

constexpr std::size_t piece_bytes = 60'000;

}  // namespace

std::vector<shoal::sim_snapshot_t> in_pieces(const Snapshot& snapshot, std::int32_t branch,
                                             std::int64_t input_sequence) {
  Snapshot without_scores = snapshot;
  without_scores.scores.clear();
  const sim::Bytes bytes = to_bytes(without_scores);
  std::vector<shoal::sim_snapshot_t> pieces((bytes.size() + piece_bytes - 1) / piece_bytes);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t begin = i * piece_bytes, size = std::min(piece_bytes, bytes.size() - begin);
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data()) + begin;
    shoal::sim_snapshot_t& piece = pieces[i];
    piece.utime = snapshot.utime();
    piece.step = snapshot.step;
    piece.branch = branch;
    piece.input_sequence = input_sequence;
    piece.piece = static_cast<std::int32_t>(i);
    piece.pieces = static_cast<std::int32_t>(pieces.size());
    piece.bytes = static_cast<std::int64_t>(bytes.size());
    piece.size = static_cast<std::int32_t>(size);
    piece.data.assign(data, data + size);
  }
  return pieces;
}

bool SnapshotPieces::continues(const shoal::sim_snapshot_t& piece) const {
  return first_ && piece.step == first_->step && piece.branch == first_->branch && piece.pieces == first_->pieces &&
         piece.bytes == first_->bytes && piece.input_sequence == first_->input_sequence;
}

std::optional<sim::Bytes> SnapshotPieces::add(const shoal::sim_snapshot_t& piece) {
  if (piece.piece < 0 || piece.piece >= piece.pieces || piece.bytes < 0)
    throw shoal::MessageError(
        fmt::format("piece {} of {} of a snapshot of {} bytes cannot be", piece.piece, piece.pieces, piece.bytes));
  // Start of another snapshot.
  if (!continues(piece)) {
    first_ = piece;
    first_->data.clear();
    next_ = lost_until_ = 0;
    bytes_.clear();
  }
  if (piece.piece < next_) return std::nullopt;  // duplicate
  // Gap before this piece.
  if (lost_until_ > next_ || piece.piece > next_) {
    lost_until_ = std::max(lost_until_, piece.piece);
    return std::nullopt;
  }
  // Append the piece.
  const auto* data = reinterpret_cast<const std::byte*>(piece.data.data());
  bytes_.insert(bytes_.end(), data, data + piece.data.size());
  ++next_;
  if (bytes_.size() > static_cast<std::uint64_t>(piece.bytes))
    throw shoal::MessageError(fmt::format("the pieces of a snapshot are more than its {} bytes", piece.bytes));
  // Check the size after the last piece.
  if (next_ < piece.pieces) return std::nullopt;
  if (bytes_.size() < static_cast<std::uint64_t>(piece.bytes))
    throw shoal::MessageError(
        fmt::format("the pieces of a snapshot are {} bytes instead of {}", bytes_.size(), piece.bytes));
  return std::move(bytes_);
}

std::string SnapshotPieces::missing() const {
  if (!first_ || next_ == first_->pieces) return "";
  const std::int32_t last = (lost_until_ > next_ ? lost_until_ : first_->pieces) - 1;
  return next_ == last ? fmt::format("piece {} of {} of the snapshot of step {} is missing", next_ + 1, first_->pieces,
                                     first_->step)
                       : fmt::format("pieces {} to {} of {} of the snapshot of step {} are missing", next_ + 1,
                                     last + 1, first_->pieces, first_->step);
}

}  // namespace experiment
