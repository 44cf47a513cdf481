#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/trace/sensor_noise.hpp>
#include <talus/terramech/trace/trial.hpp>

namespace talus::terramech {

/// Rows whose errors belong together. The part of a residual that the rows of a unit share and what is left
/// of each row are two errors, each of its own sign.
struct ExchangeableUnits {
  std::vector<int> unit;  ///< number of each row's unit from 0 on; empty: rows are on their own
  bool runs = false;      ///< units are the runs of the table, else stretches of time
  Eigen::MatrixXd left;   ///< the residual without a smooth of the columns that do not follow the units

  int count() const;
};

/// What `residual` (rows x kChannels, measured less model) shows to belong together.
/// Whole runs, where their means scatter more than their rows allow (one-way F as a normal score above 2.4).
/// Columns that a run nearly fixes are not taken out before, since a curve in time takes the offsets of a few
/// runs that follow one another with it; unless parabolas in such columns are all that sets the runs apart,
/// with four runs to spare.
/// Else stretches of time, where what a smooth of all columns leaves still correlates from row to row: twice
/// as long as that correlation lasts in what a parabola in time leaves. Not where slip, load or the like are
/// themselves in the order of time: what the model lacks lasts there, too.
ExchangeableUnits exchangeableUnits(const Trial& trial, const Whitening& whitening,
                                    const Eigen::MatrixXd& residual);

/// The part of each row and channel that its unit shares: means weighted by 1 / std^2. NaN count for nothing
/// and become 0.
Eigen::MatrixXd unitMeans(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& std,
                          const std::vector<int>& unit);

}  // namespace talus::terramech
