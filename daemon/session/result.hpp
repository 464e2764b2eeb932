// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/geometry/board.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/handeye/types.hpp"
#include "daemon/reconstruction/reconstruction.hpp"

namespace handeye {

enum class Verdict { kAccepted, kRefused, kCancelled };

/// Why a calibration was refused; the documented word of each is reason_word().
enum class Reason {
  kNone,
  kInsufficientRotation,
  kInsufficientTranslation,
  kNoMotion,
  kSingleAxis,
  kFixedPoint,
  kNoParallax,
  kTooFewFeatures,
  kImageDark,
  kImageFrozen,
  kTrackerLost,
  kCameraLost,
  kClockUnstable,
  kLensUnobservable,
  kUncertain,
  kCancelled,
};

/// "single_axis", ...; empty for kNone.
std::string_view reason_word(Reason reason);

/// Inverse of reason_word; a word this version does not know becomes kUncertain.
Reason reason_from_word(std::string_view word);

/// What the person holding the scope can do about it; one sentence. Empty for kNone.
std::string_view reason_advice(Reason reason);
/// The same for a calibration with a board, which it names.
std::string reason_advice(Reason reason, const Board& board);

/// How good an answer has to be to be accepted. Sigma: square root of the trace of the block.
struct WantedSigma {
  double rotation_deg{0.3};
  double translation_mm{1.5};
  bool operator==(const WantedSigma&) const = default;
};

/// Square roots of the traces of the rotation's and the translation's block of a covariance.
struct MethodSigma {
  double rotation_deg{0};
  double translation_mm{0};
};

struct MethodResult {
  std::string name;
  std::optional<HandEyeSolution> solution;  ///< nothing: the method found none
  Residuals residuals;
  double time_ms{0};
  std::optional<MethodSigma> sigma;  ///< of its own solution; nothing: not asked for, or not known
};

/// What a lens that was found with the calibration is worth.
struct LensQuality {
  LensSigma sigma;
  /// False: the images do not tell the lens, or the hand turned otherwise than the eye under it;
  /// the camera is a guess, whatever sigma says.
  bool observable{false};
};

/// Of one sample of the tracker, standard deviations per axis, as an answer was weighted by.
struct SampleNoise {
  double rotation_deg{0};
  double translation_mm{0};
  std::string source{"estimated"};  ///< given, measured (6dcov), estimated (from the residuals)
};

/// When an answer was found, which replays do not tell.
struct Vintage {
  std::int64_t solved_utime{0};  ///< CLOCK_REALTIME [us]
  std::optional<double> age_s;   ///< nothing: not known
  bool restored{false};          ///< by an earlier start of the daemon
};

/// Everything a calibration says; the fields of the result JSON and of result_t.
struct CalibrationResult {
  std::int64_t request_id{0};
  int body_id{0};
  Verdict verdict{Verdict::kRefused};
  Reason reason{Reason::kNone};
  std::string advice;
  /// Refused: the motion that would help most, word(MissingMotion); empty: none would, or none is
  /// known to.
  std::string missing;
  WantedSigma wanted;
  std::optional<Board> board;      ///< the eye's poses came from it; nothing: from a reconstruction
  std::optional<Vintage> vintage;  ///< nothing: of a replay

  bool has_estimate{false};  ///< false: the block below is meaningless
  std::string method;        ///< whose answer it is: a name of `methods`
  HandEyeSolution solution;
  Matrix6d covariance{
      Matrix6d::Zero()};  ///< of (w [rad], dt [mm]): R = Exp(w) R_est, t = t_est + dt
  double sigma_rotation_deg{0};
  double sigma_translation_mm{0};
  std::optional<double> time_offset_s;  ///< add to a tracker stamp to get the camera's
  std::optional<double> time_offset_sigma_s;

  CameraModel camera;
  std::string camera_source{"given"};  ///< given, refined, estimated
  std::optional<LensQuality> lens;     ///< nothing: given
  Residuals residuals;
  double reprojection_px{0};
  std::optional<SampleNoise> hand_noise;  ///< nothing: there was no answer to weigh
  double image_noise_px{0};           ///< of a feature, per axis, 0.1 at least; 0: not estimated
  std::vector<MethodResult> methods;  ///< the answer's is the last

  struct Frames {
    std::int64_t received{0}, used{0}, keyframes{0}, dropped{0};
    std::int64_t dark{0}, frozen{0};  ///< of those received; not used
    /// Of those received; used as far as they go.
    std::int64_t bright{0}, blurred{0}, interlaced{0};
  } frames;
  struct Features {
    double tracked_mean{0};
    std::int64_t points{0};
  } features;
  struct Timings {
    double tracking{0}, reconstruction{0}, handeye{0}, total{0};
  } timings_ms;
};

}  // namespace handeye
