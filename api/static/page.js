const form = document.getElementById("question");
const answer = document.getElementById("answer");

function inWords(found) {
  if (found.overturned) return `It ${found.meaning} (${found.impacts} impacts). Source: ${found.source}.`;
  const peak = `peak rotation ${found.peak_rotation.toPrecision(6)} α`;
  const bound = found.error_bound === null ? "" : `, within ${found.error_bound.toExponential(1)}`;
  return `It ${found.meaning}: ${peak}${bound}. Source: ${found.source}.`;
}

form.addEventListener("submit", async (event) => {
  event.preventDefault();
  answer.textContent = "Asking …";
  try {
    const response = await fetch("/v1/response?" + new URLSearchParams(new FormData(form)));
    const found = await response.json();
    answer.textContent = response.ok ? inWords(found) : found.detail;
  } catch (error) {
    answer.textContent = `The service does not answer: ${error.message}`;
  }
});
