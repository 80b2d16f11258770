// Time: what it is, whether it runs, how fast, and the keys and buttons for all this.

const SPEEDS = [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];
const PLAY = '<svg viewBox="0 0 10 10" aria-hidden="true"><path d="M1 0 10 5 1 10z"/></svg>';
const PAUSE = '<svg viewBox="0 0 10 10" aria-hidden="true"><path d="M1 0h3v10h-3zM6 0h3v10h-3z"/></svg>';

export class Player {
  /** Calls `show` whenever the time of `motion` has changed. */
  constructor(motion, show) {
    this.motion = motion;
    this.show = show;
    this.playing = false;
    this.button = document.getElementById("play");
    this.slider = document.getElementById("time");
    this.clock = document.getElementById("clock");
    this.repeat = document.getElementById("repeat");
    this.#speeds();
    Object.assign(this.slider, { min: motion.start, max: motion.end });
    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    this.button.addEventListener("click", () => this.toggle());
    document.addEventListener("keydown", (event) => this.#key(event));
    this.#label();
  }

  get speed() {
    return Number(this.choice.value);
  }

  seek(time) {
    this.motion.seek(time);
    const { motion, slider } = this;
    slider.value = motion.time;
    const digits = Math.min(6, Math.max(0, 3 - Math.floor(Math.log10(motion.end - motion.start || 1))));
    const now = `${motion.time.toFixed(digits)} s`;
    slider.setAttribute("aria-valuetext", now);
    this.clock.textContent = `${now} / ${motion.end.toFixed(digits)} s`;
    this.show();
  }

  play() {
    if (this.motion.time >= this.motion.end) this.seek(this.motion.start);
    this.playing = true;
    this.#label();
  }

  pause() {
    this.playing = false;
    this.#label();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  /** Lets `seconds` of the viewer's time pass. */
  advance(seconds) {
    if (!this.playing) return;
    const { motion } = this;
    // A page that was out of sight does not make up for it.
    let time = motion.time + Math.min(seconds, 0.5) * this.speed;
    if (time >= motion.end) {
      if (this.repeat.checked && motion.end > motion.start) {
        time = motion.start + ((time - motion.start) % (motion.end - motion.start));
      } else {
        time = motion.end;
        this.pause();
      }
    }
    this.seek(time);
  }

  #label() {
    this.button.innerHTML = this.playing ? PAUSE : PLAY;
    this.button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  /** True speed, unless that would be over in a blink or take longer than anybody looks. */
  #speeds() {
    this.choice = document.getElementById("speed");
    const seconds = this.motion.end - this.motion.start;
    const wanted = seconds < 2 ? seconds / 4 : seconds > 60 ? seconds / 40 : 1;
    const distance = (speed) => Math.abs(Math.log(speed / wanted));
    const usual = SPEEDS.reduce((best, speed) => (distance(speed) < distance(best) ? speed : best), 1);
    for (const speed of SPEEDS) this.choice.add(new Option(`${speed}×`, speed, false, speed === usual));
  }

  #key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.target === this.choice) return;
    const frames = event.shiftKey ? 10 : 1;
    const keys = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.#step(-frames),
      ArrowRight: () => this.#step(frames),
      Home: () => this.seek(this.motion.start),
      End: () => this.seek(this.motion.end),
    };
    // A focused button or box takes the space bar for itself.
    const taken = event.key === " " && event.target.matches("button, input[type=checkbox]");
    if (taken || !(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  }

  #step(frames) {
    this.pause();
    const { motion } = this;
    const to = motion.frame + frames + (frames < 0 && motion.part > 0 ? 1 : 0);
    this.seek(motion.t[Math.min(Math.max(to, 0), motion.t.length - 1)]);
  }
}
