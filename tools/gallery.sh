# The last part of ./demo: pages of what each job makes of real models, and a page of pages. Sourced by ./demo, which
# sets `models` and `results` and defines `value`. What is shown is made and checked here; what fails is said, left out
# and counted.

gallery_entries=
gallery_failures=0
gallery_log=$results/gallery.log

# run COMMAND...: certa in the folder of results, with the command line kept for the page as a user would type it.
run() {
  local argument line=certa
  for argument in "$@"; do
    [[ $argument =~ [^A-Za-z0-9_./%:=,-] ]] && argument="'$argument'"
    line+=" $argument"
  done
  commands+="$line"$'\n'
  (cd "$results" && "$OLDPWD/build/certa" "$@" --quiet) 2>>"$gallery_log"
}

# Text that may stand in HTML.
escaped() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/"/\&quot;/g' <<<"$1"; }

section() {
  gallery_entries+="<h2>$1</h2>"$'\n'
  printf '\n%s\n' "$1"
}

# entry TITLE FACTS PAGE STATE: one line of the list, with the commands since the last one.
entry() {
  gallery_entries+="<a target=\"stage\" href=\"$3#$4\" data-commands=\"$(escaped "$commands")\"><b>$1</b><span>$2</span></a>"$'\n'
  printf '  %-32s %s\n' "$1" "$2"
}

# job FUNCTION NAME TITLE ...: of models that could not be fetched there are no pages.
job() {
  local before=$gallery_entries
  commands=
  case $1 in
    meshed | protected | curved | remeshed)
      if ! input_of "$2" >/dev/null; then
        printf '  %-32s left out: %s is not there\n' "$3" "$2"
        return 0
      fi
      ;;
  esac
  "$@" && return 0
  gallery_entries=$before
  gallery_failures=$((gallery_failures + 1))
  printf '  %-32s FAILED: %s\n' "$3" "$(tail -n 1 "$gallery_log")"
}

# number PART KEY REPORT: a number in a part of a report, with spaces between thousands.
number() {
  sed -n "/^  \"$1\": {/,/^  }/s/^ *\"$2\": \([0-9]*\),*\$/\1/p" "$results/$3" | head -n 1 |
    sed ':a;s/\([0-9]\)\([0-9]\{3\}\)\( \|$\)/\1 \2\3/;ta'
}

input_of() {
  local input
  for input in "../models/$1".off "../models/$1".poly; do
    [ -e "$results/$input" ] && printf '%s' "$input" && return 0
  done
  return 1
}

# meshed NAME TITLE STATE VIEW_OPTION...: what ./demo has meshed and checked before.
meshed() {
  local name=$1 title=$2 state=$3 input
  shift 3
  input=$(input_of "$name") && [ -e "$results/$name.check.json" ] || return 1
  commands="certa conform $input -o $name.vtu"$'\n'"certa check $name.vtu --against $input"$'\n'
  run view "$input" "$name.vtu" "$@" -o "$name.html" &&
    entry "$title" "$(number input points "$name.json") points, $(number mesh vertices "$name.json") vertices, $(number mesh tetrahedra "$name.json") tetrahedra" "$name.html" "$state"
}

# protected NAME TITLE STATE: the thesis's own algorithm, with its balls.
protected() {
  local out=$1_balls input
  input=$(input_of "$1") || return 1
  run conform "$input" --protect sharp -o "$out.vtu" --json "$out.json" && run check "$out.vtu" --against "$input" &&
    run view "$input" "$out.vtu" -o "$out.html" &&
    entry "$2" "$(number statistics protecting_balls "$out.json") balls, $(number mesh vertices "$out.json") vertices, $(number mesh tetrahedra "$out.json") tetrahedra" "$out.html" "$3"
}

# curved NAME TITLE STATE VIEW_OPTION...
curved() {
  local name=$1 title=$2 state=$3 out=$1_curvature input
  shift 3
  input=$(input_of "$name") && run curvature "$input" -o "$out.vtu" --json "$out.json" &&
    run view "$out.vtu" "$@" -o "$out.html" &&
    entry "$title" "curvatures and directions of $(number input points "$out.json") vertices" "$out.html" "$state"
}

# remeshed NAME TITLE STATE VERTICES VIEW_OPTION...
remeshed() {
  local name=$1 title=$2 state=$3 vertices=$4 out=$1_few input
  shift 4
  input=$(input_of "$name") &&
    run remesh "$input" --vertices "$vertices" --lines "$out.lines.vtu" -o "$out.obj" --json "$out.json" &&
    run check "$out.obj" --against "$input" &&
    run view "$input" "$out.lines.vtu" "$out.obj" "$@" -o "$out.html" &&
    entry "$title" "$(number statistics input_vertices "$out.json") vertices become $(number statistics vertices "$out.json"); $(number statistics quads "$out.json") of $(number statistics faces "$out.json") faces are quads" "$out.html" "$state"
}

# certified NAME TITLE STATE FUNCTION OPTION...
certified() {
  local name=$1 title=$2 state=$3 function=$4
  shift 4
  run implicit "$function" "$@" -o "$name.ply" --certificate "$name.certificate.json" --json "$name.json" &&
    run check "$name.ply" --against "$function" --certificate "$name.certificate.json" &&
    run view "$name.ply" "$name.certificate.json" -o "$name.html" &&
    entry "$title" "genus $(value genus "$results/$name.json"), $(number mesh vertices "$name.json") vertices, $(number statistics clusters "$name.json") critical clusters" "$name.html" "$state"
}

# undecided NAME TITLE STATE FUNCTION: what cannot be certified, and where.
undecided() {
  local status=0
  run implicit "$4" --uncertified -o "$1.ply" --json "$1.json" || status=$?
  [ "$status" -eq 4 ] && run view "$1.ply" "$1.json" -o "$1.html" &&
    entry "$2" "exit code 4: $(value reason "$results/$1.json"), with the box; the mesh is a guess, and says so" "$1.html" "$3"
}

# chained NAME TITLE STATE FUNCTION OPTION...: a formula becomes a certified surface, that a coarse one, that tetrahedra.
chained() {
  local name=$1 title=$2 state=$3 function=$4
  shift 4
  run implicit "$function" "$@" --error 0.003 -o "$name.off" --json "$name.json" &&
    run remesh "$name.off" --error 0.5% --output triangles --lines "$name.lines.vtu" -o "$name.few.off" --json "$name.few.json" &&
    run check "$name.few.off" --against "$name.off" &&
    run conform "$name.few.off" -o "$name.solid.vtu" --json "$name.solid.json" &&
    run check "$name.solid.vtu" --against "$name.few.off" &&
    run view "$name.off" "$name.lines.vtu" "$name.few.off" "$name.solid.vtu" -o "$name.html" &&
    entry "$title" "genus $(value genus "$results/$name.json"), $(number mesh triangles "$name.json") triangles become $(number statistics triangles "$name.few.json"), then $(number mesh tetrahedra "$name.solid.json") tetrahedra" "$name.html" "$state"
}

# The page of pages: plain links into a frame, so that it works from a file, and without scripts.
write_gallery() {
  local first
  first=$(sed -n 's/.* href="\([^"]*\)".*/\1/p' <<<"$gallery_entries" | head -n 1)
  cat >"$results/gallery.html" <<PAGE
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Certa: gallery</title>
<style>
:root { --ground: #f0f3f5; --sheet: #fff; --text: #1f2a35; --quiet: #66727f; --line: rgba(31,42,53,.12); --accent: #2a6f8a; --on: #fff; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #14181d; --sheet: #1b2128; --text: #e4e9ee; --quiet: #8f9ba8; --line: rgba(228,233,238,.13); --accent: #6fb3c9; --on: #10181d; }
}
* { box-sizing: border-box; }
body {
  margin: 0; height: 100vh; display: grid; grid-template: minmax(0, 1fr) auto / 330px minmax(0, 1fr); color: var(--text); background: var(--ground);
  font: 13px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; font-variant-numeric: tabular-nums;
}
nav { grid-row: 1 / 3; overflow: auto; padding: 18px 12px; background: var(--sheet); border-right: 1px solid var(--line); }
h1 { margin: 0 10px 4px; font-size: 17px; font-weight: 650; letter-spacing: -.02em; }
h1 + p { margin: 0 10px; color: var(--quiet); }
h2 { margin: 18px 10px 4px; font-size: 11px; font-weight: 600; letter-spacing: .05em; text-transform: uppercase; color: var(--quiet); }
a { display: block; padding: 6px 10px; border-radius: 8px; color: inherit; text-decoration: none; }
a:hover { background: var(--ground); }
a:focus-visible { outline: 2px solid var(--accent); }
a b { display: block; font-weight: 600; }
a span { color: var(--quiet); font-size: 12px; }
a.on { background: var(--accent); color: var(--on); }
a.on span { color: inherit; opacity: .85; }
iframe { width: 100%; height: 100%; border: 0; }
pre {
  margin: 0; padding: 10px 20px; overflow: auto; max-height: 9.5em; border-top: 1px solid var(--line); background: var(--sheet); color: var(--quiet);
  font: 12px/1.5 ui-monospace, "DejaVu Sans Mono", monospace;
}
pre:empty { display: none; }
@media (max-width: 760px) {
  body { grid-template: 32vh minmax(0, 1fr) / minmax(0, 1fr); }
  nav { grid-row: auto; border: 0; border-bottom: 1px solid var(--line); }
  pre { display: none; }
}
</style>
</head>
<body>
<nav aria-label="Results"><h1>Certa: gallery</h1><p>Made by ./demo, every result checked. Drag turns, the wheel zooms, keys 1 to 4 switch between input and output.</p>
$gallery_entries</nav>
<iframe name="stage" title="The chosen result" src="$first"></iframe>
<pre aria-label="Commands that made it"></pre>
<script>
const links = [...document.querySelectorAll('nav a')];
const mark = (link) => {
  for (const one of links) one.classList.toggle('on', one === link);
  document.querySelector('pre').textContent = link.dataset.commands.trim();
};
for (const link of links) link.addEventListener('click', () => mark(link));
if (links.length) mark(links[0]);
</script>
</body>
</html>
PAGE
}

make_gallery() {
  local tangle="x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8" torus="(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"
  : >"$gallery_log"
  section "Conforming Delaunay tetrahedra"
  job meshed fandisk "fandisk, cut" "file=2&clip=-y,0.62"
  job meshed elephant "elephant, cut" "file=2&clip=-z,0.5&view=200,10" --up y
  job meshed joint "joint" "file=2&view=-40,30"
  job meshed block_with_fin "two regions, a fin at 7 degrees" "file=2&clip=off"
  job protected fan_ten_degrees "protecting balls and shield edges" "file=2&show=facets"
  section "Curvature"
  job curved bunny00 "bunny, mean curvature" "color=mean&edges=none" --up y
  job curved elephant "elephant, principal directions" "directions=dir_min,dir_max&color=plain&view=60,15" --up y
  section "Remeshing along lines of curvature"
  job remeshed bunny00 "bunny" "file=3" 1500 --up y
  job remeshed fandisk "fandisk, lines and umbilics" "file=2&view=-50,25" 500
  section "Implicit surfaces with certified topology"
  job certified tangle_cube "tangle cube, inside and outside" "file=2" "$tangle" --box -3 -3 -3 3 3 3
  job certified torus "torus, critical clusters" "file=2" "$torus"
  job undecided cone "cone: refused, with the place" "file=2" "x^2 + y^2 - z^2"
  section "The chain"
  job chained chain "formula to tetrahedra" "file=4&clip=-y,0.8" "$tangle" --box -3 -3 -3 3 3 3
  write_gallery
}
