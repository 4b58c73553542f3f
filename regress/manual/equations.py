#!/usr/bin/env python3
"""Equations of the book: weasyprint has no MathML, so each <math> of stdin becomes boxes of HTML on stdout (style.css).

A box is (html, above, below): its height above and below the base line, in ems."""
import html
import re
import sys
import xml.etree.ElementTree as tree

ABOVE, BELOW, AXIS = .85, .15, .28    # of a line of height 1, and where fractions have their bar
SMALL, LARGE = .72, 1.3               # size of indices, of sums and integrals
RELATIONS = set('= < > ≤ ≥ ≠ ∼ ≪ ≫ → ← := ∈'.split())
TERMS = set('− + ± ⋅ × ⊗ *'.split())
OPEN, CLOSE = set('([{⟨'), set(')]}⟩')


def span(content, name='', style=''):
    return '<span%s%s>%s</span>' % (f' class="{name}"' if name else '', f' style="{style}"' if style else '', content)


def stack(rows, last, name='', gap=0.):
    """Rows (box, size) one above the other, centred; the base line of the last one lies `last` below that around."""
    height = sum(size * (above + below) for (_, above, below), size in rows) + gap
    inside = ''.join(span(box[0], 'row', f'font-size:{size}em; padding-bottom:{0 if number else gap / size:.2f}em')
                     for number, (box, size) in enumerate(rows))
    below = last + rows[-1][1] * rows[-1][0][2]
    return span(inside, 'stack ' + name, f'vertical-align:{-last:.2f}em'), height - below, below


def fraction(above, below):
    return stack([(above, 1), (below, 1)], below[1] + .1 - AXIS, 'frac')


def moved(box, up):
    """An index, its base line `up` above that of its base."""
    return span(box[0], 'small', f'vertical-align:{up / SMALL:.2f}em'), up + SMALL * box[1], SMALL * box[2] - up


def scripts(base, low, high):
    down, up = max(.22, base[2] + .02), max(.38, base[1] - .4)
    if low and high:
        gap = max(0, up + down - SMALL * (high[2] + low[1]))
        return row([base, stack([(high, SMALL), (low, SMALL)], down, 'left', gap)])
    return row([base] + ([moved(high, up)] if high else []) + ([moved(low, -down)] if low else []))


def limits(base, low, high):
    rows = ([(high, SMALL)] if high else []) + [(base, 1)] + ([(low, SMALL)] if low else [])
    return stack(rows, base[2] + SMALL * low[1] if low else 0)


def row(boxes):
    return ''.join(b[0] for b in boxes), max([ABOVE] + [b[1] for b in boxes]), max([BELOW] + [b[2] for b in boxes])


def stretched(sign, above, below):
    """A fence, root or bar as high as what it stands beside."""
    grow, down = above + below, (ABOVE - BELOW - above + below) / 2
    if grow < 1.2:
        return sign, ABOVE, BELOW
    return span(sign, 'fence', f'transform:translateY({down:.2f}em) scaleY({grow:.2f})'), above, below


def operator(node, before):
    text = node.text or ''
    if text in RELATIONS:
        return span('\u200b' + html.escape(text), 'relation')
    if text in TERMS and before is not None and not (before.tag == 'mo' and before.get('form') != 'postfix'):
        return span('\u200b' + text, 'term')
    if text in (',', ';'):
        return span(text, 'comma')
    return span(text, 'name') if text.isalpha() and len(text) > 1 else html.escape(text)


def content(node):
    """What stands in an mrow: fences are as high as what lies between them."""
    boxes, opened, before = [], [], None
    for child in node:
        if child.tag == 'mo' and child.get('form') == 'prefix':
            opened.append(len(boxes))
            boxes.append((child.text, ABOVE, BELOW))
        elif child.tag == 'mo' and child.get('form') == 'postfix' and opened:
            first = opened.pop()
            inside = row(boxes[first + 1:])
            boxes[first] = stretched(boxes[first][0], inside[1], inside[2])
            boxes.append(stretched(child.text, inside[1], inside[2]))
        elif child.tag == 'mo' and child.text not in ('∑', '∫', '∬', '∮'):
            boxes.append((operator(child, before), ABOVE, BELOW))
        else:
            boxes.append(box(child))
        before = child
    return row(boxes)


def box(node):
    tag, parts = node.tag, list(node)
    if tag in ('mrow', 'mstyle', 'math', 'mtd'):
        inside = content(node)
        kind = {'normal': 'upright', 'script': 'script'}.get(node.get('mathvariant'), '')
        return (span(inside[0], kind), *inside[1:]) if kind else inside
    if tag == 'mi':
        return span(html.escape(node.text), 'italic' if len(node.text) == 1 and node.get('mathvariant') != 'normal' else ''), ABOVE, BELOW
    if tag in ('mn', 'mtext'):
        return html.escape(node.text or ''), ABOVE, BELOW
    if tag == 'mspace':
        return span('\u200b' if float(node.get('width')[:-2]) > .5 else '', '', f'padding-left:{node.get("width")}'), 0, 0
    if tag == 'mo':
        return (span(node.text, 'large'), LARGE * ABOVE, LARGE * BELOW) if node.text in '∑∫∬∮' else (operator(node, None), ABOVE, BELOW)
    if tag == 'mfrac':
        return fraction(box(parts[0]), box(parts[1]))
    if tag == 'msqrt':
        inside = content(node)
        return row([stretched('√', inside[1], inside[2]), (span(inside[0], 'root'), inside[1] + .05, inside[2])])
    if tag == 'mover' and parts[1].get('accent'):
        accent, base = parts[1].text, box(parts[0])
        if accent == '‾':
            return span(base[0], 'root'), base[1] + .05, base[2]
        return re.sub(r'(\w)(?=[^\w>]*(<|$))', r'\1' + accent, base[0], count=1), base[1], base[2]
    if tag in ('msub', 'msup', 'msubsup', 'munder', 'mover', 'munderover'):
        low = box(parts[1]) if tag not in ('msup', 'mover') else None
        high = box(parts[-1]) if tag not in ('msub', 'munder') else None
        return (limits if 'under' in tag or 'over' in tag else scripts)(box(parts[0]), low, high)
    if tag == 'mtable':
        rows = [[box(cell) for cell in line] for line in parts]
        text = ''.join(span(''.join(span(cell[0], 'cell ' + source.get('columnalign', 'center')) for cell, source in zip(line, node_line)), 'line')
                       for line, node_line in zip(rows, parts))
        half = sum(r[1] + r[2] + .3 for r in map(row, rows)) / 2
        return span(text, 'table'), half + AXIS, half - AXIS
    raise SystemExit(f'equations.py: no box for <{tag}>')


def equation(match):
    math = tree.fromstring(re.sub(r' xmlns="[^"]*"', '', match[0]))
    inside = box(math.find('semantics')[0])
    return span(inside[0], 'math')


sys.stdout.write(re.sub(r'<math.*?</math>', equation, sys.stdin.read(), flags=re.S))
