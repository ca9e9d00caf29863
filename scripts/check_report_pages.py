"""Pages with known faults, and one without: what scripts/check_report.py --self-test has to find, and where it has to be silent."""

FRAME = """<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>A page</title><link rel="icon" href="data:,"><style>
:root {{ --page: #fff; --ink: #222 }} body {{ background: var(--page); color: var(--ink); margin: 8px }}
@media screen and (prefers-color-scheme: dark) {{ :root {{ --page: #14181e; --ink: #e8ecf1 }} }} {style}
</style></head><body><main>{body}</main></body></html>"""


def page(body, style=""):
    return FRAME.format(body=body, style=style)


# As small as a page can be that has all that is used of a report. The last state is the second, and a picture is its state in words.
CONTROLS = """<h1>Sheet</h1><p id="readout">0 mm</p><input id="state" type="range" min="0" max="1" value="1" aria-label="State">
<button id="play">Play</button>
<label><input type="radio" name="field" value="strain" checked> strain</label><label><input type="radio" name="field" value="stress"> stress</label>
<label><input type="radio" name="focus" value="punch" checked> punch</label><label><input type="radio" name="focus" value="die"> die</label>
<label><input type="radio" name="focus" value="middle"> middle</label>
<div id="whole">-</div><div id="near">-</div><div id="pressure">-</div><div id="force">-</div>
<script>
const one = id => document.getElementById(id), slider = one("state"); let clicks = 0;
const draw = () => {{ for (const id of {drawn}) one(id).textContent = [slider.value, clicks,
  ...[...document.querySelectorAll("input:checked")].map(e => e.value)].join(" "); }};
slider.oninput = document.onchange = draw; one("whole").onclick = () => {{ clicks++; draw(); }};
one("play").onclick = () => {{ {play} }}; draw();
</script>"""


def controls(drawn="['whole', 'near', 'pressure', 'force']", play="slider.value = 1; draw()"):
    return page(CONTROLS.format(drawn=drawn, play=play))


# A page, what is done with it, and parts of the problems that have to be found: no more and no fewer.
PAGES = [
    ("a good page", page("<h1>Good</h1><h2>Better</h2><p>Text</p><button>Go</button>"), "read", []),
    ("a page that is not too wide", page("<h1>A</h1><p>Text</p>"), "measured", []),
    ("grey on grey", page("<h1>A</h1><p style='color: #999; background: #ccc'>hardly</p>"), "read",
     ['(dark): p "hardly": 1.7', '(light): p "hardly": 1.7']),
    ("a grey that is enough on white only", page("<h1>A</h1><p style='color: #666'>by day</p>"), "read", ['(dark): p "by day"']),
    ("just too little", page("<h1>A</h1><p style='color: #777; background: #fff'>nearly</p>"), "read", ['"nearly": 4.4', '"nearly": 4.4']),
    ("large text", page("<h1>A</h1><p style='color: #777; background: #fff; font-size: 24px'>large</p>"), "read", []),
    ("faded by its box", page("<h1>A</h1><div style='opacity: .3'><p>pale</p></div>"), "read", ['"pale"', '"pale"']),
    ("ink that is let through", page("<h1>A</h1><p style='color: rgba(0,0,0,.3); background: #fff'>thin</p>"), "read", ['"thin"', '"thin"']),
    ("a wash over the page", page("<h1>A</h1><div style='background: rgba(0,0,0,.6)'><p style='color: #222'>murky</p></div>"), "read",
     ['"murky"', '"murky"']),
    ("a picture's text", page("<h1>A</h1><svg aria-hidden='true'><text y='20' fill='#bbb' style='font-size: 12px'>axis</text></svg>",
                              "main { background: #fff } h1 { color: #222 }"), "read", ['text "axis"', 'text "axis"']),
    ("no names", page("<h1>A</h1><h3>B</h3><button></button><p id='x'>1</p><p id='x'>2</p>"), "read",
     ["button# has no name", "h3 behind h1", "#x is there twice"]),
    ("beyond the keyboard", page("<h1>A</h1><button id='b' tabindex='-1'>Go</button>"), "read", ["does not reach ['b']"]),
    ("where the keyboard is cannot be seen", page("<h1>A</h1><button id='b'>Go</button>", "button { outline: none }"), "read", ["b does not show"]),
    ("too wide", page("<h1>A</h1><div style='width: 1000px'>wide</div>"), "measured", ["window of 390", "window of 768", "window of 900"]),
    ("a request", page("<h1>A</h1><img alt='' src='file:///nowhere.png'>"), "loaded", ["logs", "asks for file:///nowhere.png"]),
    ("an error", page("<h1>A</h1><script>nothing.there()</script>"), "loaded", ["logs"]),
    ("a dark sheet of paper", page("<h1>A</h1>"), "printed", ["as next to nothing", "prints on #14181e"]),
    ("a table that is cut on paper", page("<h1>A</h1><div id='t' style='overflow-x: auto'><p style='width: 900px'>long</p></div>"), "printed",
     ["as next to nothing", "prints on #14181e", "wider than a sheet of paper: ['t']"]),
    ("two states", controls(), "used", []),
    ("a dead picture", controls(drawn="['whole', 'near', 'pressure']"), "used", ["the slider does not change force"]),
    ("a dead button", controls(play=""), "used", ["the play button does not play"]),
]
