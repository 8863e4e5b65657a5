// Animation trajectory: angle of the block and displacement of the ground at any time, until the block lies.

const STEP = 0.02; // [tau]

/** Slenderness angle at which a block of the slender limit is drawn [rad]: the limit itself has no shape. */
export const DRAWN_ALPHA = 0.2;

/**
 * Trajectory from a response of /v1/history: times tau, angles [rad], displacements of the ground over R [-].
 *
 * The displacement is (4/3) tan(alpha) times the double integral of a f over tau, because g/p^2 = 4R/3.
 */
export function trajectoryOf(history, alpha) {
  const trajectory = { alpha, tau: [...history.tau], angle: history.rotation.map((y) => y * alpha), ground: [0] };
  const factor = (4 / 3) * Math.tan(alpha);
  let speed = 0;
  for (let n = 1; n < trajectory.tau.length; n += 1) {
    const step = trajectory.tau[n] - trajectory.tau[n - 1];
    const [before, after] = [history.ground_acceleration[n - 1], history.ground_acceleration[n]];
    // exact for an acceleration that is linear between the samples
    trajectory.ground.push(trajectory.ground[n - 1] + speed * step + factor * step * step * (before / 3 + after / 6));
    speed += (factor * step * (before + after)) / 2;
  }
  if (history.overturned) addOverturning(trajectory, history.angular_velocity.at(-1) * alpha, speed);
  return trajectory;
}

/** The solver stops where overturning is certain; the rest follows theta'' = sin(theta - alpha), without ground motion. */
function addOverturning(trajectory, velocity, speed) {
  const sign = Math.sign(trajectory.angle.at(-1)) || 1;
  let [angle, rate] = [Math.abs(trajectory.angle.at(-1)), Math.max(sign * velocity, 0.05)];
  while (angle < Math.PI / 2) {
    rate += STEP * Math.sin(Math.max(angle - trajectory.alpha, 0.01));
    angle = Math.min(angle + STEP * rate, Math.PI / 2);
    append(trajectory, sign * angle, speed);
  }
  for (let rest = 0; rest < 1; rest += STEP) append(trajectory, (sign * Math.PI) / 2, speed);
}

function append(trajectory, angle, speed) {
  trajectory.tau.push(trajectory.tau.at(-1) + STEP);
  trajectory.angle.push(angle);
  trajectory.ground.push(trajectory.ground.at(-1) + STEP * speed);
}

/** Angle [rad] and displacement of the ground over R at a time, linear between the samples. */
export function frameAt(trajectory, tau) {
  const { tau: times } = trajectory;
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const half = (low + high) >> 1;
    if (times[half] <= tau) low = half;
    else high = half;
  }
  const share = times[high] > times[low] ? Math.min(Math.max((tau - times[low]) / (times[high] - times[low]), 0), 1) : 0;
  const between = (values) => values[low] + share * (values[high] - values[low]);
  return { angle: between(trajectory.angle), ground: between(trajectory.ground) };
}

/** Smallest and largest horizontal coordinate of the block [R]; relative to the ground if `followsGround`. */
export function horizontalExtent(trajectory, followsGround) {
  const [b, h] = [Math.sin(trajectory.alpha), Math.cos(trajectory.alpha)];
  const found = [Infinity, -Infinity];
  trajectory.angle.forEach((angle, n) => {
    const side = angle >= 0 ? 1 : -1;
    const pivot = (followsGround ? 0 : trajectory.ground[n]) + side * b;
    for (const [dx, dy] of [[0, 0], [-2 * side * b, 0], [0, 2 * h], [-2 * side * b, 2 * h]]) {
      const x = pivot + dx * Math.cos(angle) + dy * Math.sin(angle); // clockwise
      found[0] = Math.min(found[0], x);
      found[1] = Math.max(found[1], x);
    }
  });
  return found;
}
