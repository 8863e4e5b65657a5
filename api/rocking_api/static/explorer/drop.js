// Files that are dropped anywhere on a page, which has one field for files.

const field = document.getElementById("file");

/** Call `take(file)` with the first of the files that are dropped; the field shows its name. */
export function onDrop(take) {
  addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    const [dropped] = event.dataTransfer.files;
    if (!dropped) return;
    field.files = event.dataTransfer.files;
    take(dropped);
  });
}
