// What there is to see of a motion: angle of the block and way of the ground at any time, the fall to its end.

const STEP = 0.02; // [tau]

/** Slenderness angle at which a block of the slender limit is drawn [rad]: the limit itself has no shape. */
export const DRAWN_ALPHA = 0.2;

/**
 * Film of an answer of /v1/history: times tau, angles [rad] and ways of the ground over R [-].
 *
 * The ground goes (4/3) tan(alpha) times the double integral of a f over tau, because g/p^2 = 4R/3.
 */
export function filmOf(history, alpha) {
  const film = { alpha, tau: [...history.tau], angle: history.rotation.map((y) => y * alpha), ground: [0] };
  const factor = (4 / 3) * Math.tan(alpha);
  let speed = 0;
  for (let n = 1; n < film.tau.length; n += 1) {
    const step = film.tau[n] - film.tau[n - 1];
    const [before, after] = [history.ground_acceleration[n - 1], history.ground_acceleration[n]];
    // exact for an acceleration that is linear between the samples
    film.ground.push(film.ground[n - 1] + speed * step + factor * step * step * (before / 3 + after / 6));
    speed += (factor * step * (before + after)) / 2;
  }
  if (history.overturned) fall(film, history.angular_velocity.at(-1) * alpha, speed);
  return film;
}

/** The solver stops where nothing can bring the block back; gravity alone, theta'' = sin(theta - alpha), lays it down. */
function fall(film, velocity, speed) {
  const sign = Math.sign(film.angle.at(-1)) || 1;
  let [angle, rate] = [Math.abs(film.angle.at(-1)), Math.max(sign * velocity, 0.05)];
  while (angle < Math.PI / 2) {
    rate += STEP * Math.sin(Math.max(angle - film.alpha, 0.01));
    angle = Math.min(angle + STEP * rate, Math.PI / 2);
    add(film, sign * angle, speed);
  }
  for (let rest = 0; rest < 1; rest += STEP) add(film, (sign * Math.PI) / 2, speed);
}

function add(film, angle, speed) {
  film.tau.push(film.tau.at(-1) + STEP);
  film.angle.push(angle);
  film.ground.push(film.ground.at(-1) + STEP * speed);
}

/** Angle [rad] and way of the ground over R at a time, between the samples. */
export function frameAt(film, tau) {
  const { tau: times } = film;
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const half = (low + high) >> 1;
    if (times[half] <= tau) low = half;
    else high = half;
  }
  const share = times[high] > times[low] ? Math.min(Math.max((tau - times[low]) / (times[high] - times[low]), 0), 1) : 0;
  const between = (values) => values[low] + share * (values[high] - values[low]);
  return { angle: between(film.angle), ground: between(film.ground) };
}

/** From where to where the block reaches [R], seen standing still or, if `rides`, from the ground. */
export function reachOf(film, rides) {
  const [b, h] = [Math.sin(film.alpha), Math.cos(film.alpha)];
  const found = [Infinity, -Infinity];
  film.angle.forEach((angle, n) => {
    const side = angle >= 0 ? 1 : -1;
    const pivot = (rides ? 0 : film.ground[n]) + side * b;
    for (const [x, y] of [[0, 0], [-2 * side * b, 0], [0, 2 * h], [-2 * side * b, 2 * h]]) {
      const place = pivot + x * Math.cos(angle) + y * Math.sin(angle); // clockwise
      found[0] = Math.min(found[0], place);
      found[1] = Math.max(found[1], place);
    }
  });
  return found;
}
