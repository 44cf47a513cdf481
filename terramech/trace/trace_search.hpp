#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/trace/folds.hpp>
#include <talus/terramech/trace/trace_result.hpp>

namespace talus::terramech {

/// The state of one search: a model that grows, the rows, and what is known of their noise. Used by
/// traceResiduals().
class TraceSearch {
 public:
  TraceSearch(const RefinedModel& base, const Trial& trial, const TraceOptions& options);

  const RefinedModel& model() const { return model_; }

  /// Rows that one derivative of the model by its free parameters solves, and a few more: what a step of the
  /// search costs, the same on any machine.
  double work() const;

  /// A candidate tried to first order.
  struct Screened {
    Candidate candidate;        ///< empirical ones only with the channels that pay
    Eigen::MatrixXd direction;  ///< whitened change of the readings
    double score = 0.0;
  };

  /// All candidates by the log-likelihood that they would gain to first order, less their penalty; best
  /// first.
  std::vector<Screened> screen();

  /// Whether the residuals hold anything at all.
  std::vector<CovariateTest> test(const std::vector<Screened>& screened);

  /// The most promising candidates fitted inside the full model, ranked by their likelihood on rows held out.
  std::vector<Explanation> fitBest(const std::vector<Screened>& screened);

  /// Which of the ranked is selected: the best known form unless a curve explains clearly more; none when
  /// nothing pays.
  std::optional<std::size_t> choose(const std::vector<Explanation>& ranked) const;

  /// Puts a candidate into the model, fits everything again and estimates the noise again.
  void accept(const Candidate& candidate);

  /// Keeps the first parameter of the effect accepted first near what was known of it before.
  void trust(const Estimate& prior) { first_prior_ = prior; }

  /// Takes accepted candidate number k out, fits everything again and estimates the noise again.
  void drop(std::size_t k);

  /// Takes accepted candidate number k out and fits the others again, the noise as it is.
  void leaveOut(std::size_t k);

  /// Takes those forms out of accepted candidate number k, one by one, without which the squared length of
  /// the whitened residuals, all else fitted again, is not larger by more than `least_gain`; one form stays.
  void thin(std::size_t k, double least_gain);

  /// The effects of accepted candidate number k as they are now in the model.
  std::vector<Effect> parts(std::size_t k) const;

  /// Squared length of the whitened residuals.
  double chi2() const { return white_.squaredNorm(); }

  /// What would explain the rows in place of accepted candidate number k, the others kept and the noise as it
  /// is now known: before the first effect was in, the noise was only guessed.
  std::vector<Explanation> rivals(std::size_t k);

  /// Takes accepted candidate number k out and puts another in, which becomes the last.
  void replace(std::size_t k, const Candidate& candidate);

  /// What two known forms together would explain in place of accepted candidates, the others kept and the
  /// noise as it is, best first; and what those candidates do themselves, judged in the same way. The first
  /// of a pair is fitted alone, the second is the best beside it, then both are fitted together: one curve,
  /// or a wider form, may take two effects at once so that neither is missed any more.
  std::vector<Explanation> pairsInPlaceOf(std::vector<std::size_t> members, Explanation& present);

  /// Takes accepted candidates out and puts a pair in, as the last two.
  void replaceByPair(std::vector<std::size_t> members, const Candidate& pair);

  /// Gives curves more knots where the rows they were fitted to pay for them. Which curve there is was judged
  /// on rows held out in bands; how fine it is cannot be, since a band that is not seen asks what lies
  /// between.
  void refineCurves();

  /// Fills the result's model, errors and standard deviations.
  void finish(TraceResult& result);

 private:
  void refresh();
  void backToMeasured();
  /// Fits the noise to residuals that hold nothing else, at the measured inputs, and all that follows from
  /// it.
  void settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
              const InputSlopes& measured_slopes);
  /// Finds what rows of a run or of a stretch of time share, and the noise without it.
  void shareWithin(Eigen::MatrixXd smooth, const Eigen::MatrixXd& level, const InputSlopes& measured_slopes);
  Channel strongest(std::size_t effect);  ///< where taking it out, all else left, changes most [noise]

  void fitSoil();
  FitPlan planFor(const RefinedModel& model) const;
  std::size_t firstPart(std::size_t k) const;  ///< of accepted candidate number k among the model's effects
  double penalty(const Candidate& candidate) const;
  Eigen::VectorXd sinkages(const Eigen::MatrixXd& level) const;
  Screened screenLibrary(const Candidate& candidate, const Eigen::MatrixXd& nuisance);
  Screened screenSoilCurve(const Candidate& candidate, const Eigen::MatrixXd& nuisance);
  Screened screenCurves(const Candidate& candidate, const Eigen::MatrixXd& nuisance);
  Eigen::VectorXd change(const RefinedModel& moved);

  /// Rows held out, and what the model without a candidate leaves there.
  struct HeldRows {
    Trial seen, unseen;
    Whitening white_seen, white_unseen;
    std::vector<char> is_seen;  ///< of all rows
    double chi2 = 0.0;
    std::array<double, kChannels> by_channel{};
  };
  void judgeHeldOut(const std::vector<HeldRows>& folds, const RefinedModel& fitted, SolvedContacts& solved,
                    Explanation& candidate) const;
  /// All rows in folds, and by a curve's column, once asked for, in whole levels of it.
  struct Held {
    std::vector<HeldRows> folds;
    std::map<std::string, std::vector<HeldRows>> levels;
  };
  std::vector<HeldRows> heldRows(const Folds& folds);
  Held held();
  const std::vector<HeldRows>& heldLevels(const Candidate& curve, Held& known);
  void setModel(const RefinedModel& model);  ///< the noise as it is
  /// Adds the best seconds beside a first that was fitted, to first order.
  void addPairs(const Explanation& first, const std::vector<Screened>& screened,
                std::vector<Screened>& pairs) const;
  /// The best known form of each family, fitted alone and not judged.
  std::vector<Explanation> firsts(const std::vector<Screened>& screened) const;
  /// Pairs in addition to the model, in place of what gains so much chi-squared.
  std::vector<Explanation> pairs(double gain, Held& held);
  Explanation fitted(const Candidate& candidate, Held& held);
  HeldRows errorsOn(const HeldRows& fold, const RefinedModel& start, const Eigen::MatrixXd& derivative) const;
  Eigen::MatrixXd derivativeOf(const RefinedModel& model, SolvedContacts& solved) const;

  TraceOptions options_;
  RefinedModel model_;
  Trial trial_;
  SolvedContacts solved_;
  Eigen::MatrixXd level_, residual_;
  std::optional<Eigen::MatrixXd> by_slip_;  ///< change by one std of the error that all slips share, where
                                            ///< there is one level of slip or one speed
  Whitening whitening_;
  Eigen::VectorXd white_;
  ExchangeableUnits units_;
  std::optional<Estimate> first_prior_;  ///< of a correction that is never taken out
  std::size_t given_effects_;            ///< of the base, in front; fitted, never taken out
  std::vector<std::size_t> part_count_;  ///< effects in the model of each accepted candidate
};

}  // namespace talus::terramech
