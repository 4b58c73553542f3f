-- What pandoc makes of the manual's pages, for the site (mode 'site': .md becomes .html in links) and for the book (mode
-- 'book': all pages are one, so that identifiers begin with their page). PAGE is the page's path from the top of the tree.
local page, mode = os.getenv('PAGE'), os.getenv('MODE')

local function whole(path) -- a path from the page, as one from the top of the tree
    local parts = {}
    for part in ((page:match('.*/') or '') .. path):gmatch('[^/]+') do
        if part == '..' then table.remove(parts) elseif part ~= '.' then parts[#parts + 1] = part end
    end
    return table.concat(parts, '/')
end
local function name(path) return (path:gsub('[^%w]', '-')) end
local function up() return page == 'README.md' and '' or ('../'):rep(select(2, page:gsub('/', '')) - 1) end

function Link(link)
    if link.target:match('^%a+:') then return nil end
    local file, anchor = link.target:match('^([^#]*)#?(.*)$')
    local target = file == '' and page or whole(file)
    local table_file = mode == 'site' and target:match('^doc/.*%.txt$')
    if not (target == 'README.md' or target:match('^doc/.*%.md$') or table_file) then return link.content end
    local chapter = #link.content == 1 and link.content[1].text and link.content[1].text:match('^([%a-]+)%.md$')
    if chapter then link.content = { pandoc.Str((chapter:gsub('-', ' '))) } end
    if mode == 'book' then
        link.target = '#' .. name(target) .. (anchor ~= '' and '--' .. anchor or '')
    elseif file ~= '' then
        target = target == 'README.md' and 'readme.html' or target:gsub('^doc/', ''):gsub('README%.md$', 'index.md'):gsub('%.md$', '.html')
        link.target = up() .. target .. (anchor ~= '' and '#' .. anchor or '')
    end
    return link
end
function Image(image)
    local target = whole(image.src)
    image.src = mode == 'book' and target or up() .. target:gsub('^doc/', '')
    return image
end
function Para(para)
    local first, second = para.content[1], para.content[2]
    if #para.content == 1 and first.t == 'Image' then return pandoc.Div(para, { class = 'picture' }) end
    if first and first.t == 'Math' and first.mathtype == 'DisplayMath' and (not second or second.t == 'Span') then
        return pandoc.Div(para, { class = 'equation' })
    end
end
function Code(code) -- short names stay in one piece, what is long may break anywhere in a table
    local long = code.text:match(('%S'):rep(24))
    if long or not code.text:find(' ') then code.classes:insert(long and 'long' or 'whole') end
    return code
end
function Str(str) -- lines would break behind the point or the minus of .25e-3
    return str.text:match('^%p*%.%d') and pandoc.Span(str, { class = 'whole' }) or nil
end
function Header(header)
    if mode == 'book' then header.identifier = header.level == 1 and name(page) or name(page) .. '--' .. header.identifier end
    return header
end
-- Display equations: the number of \tag stands beside, as not every writer of equations has it
local function numbered(text)
    local number = text:match('\\tag{(.-)}')
    local shown = pandoc.Math('DisplayMath', (text:gsub('\\tag{.-}', '')))
    return number and { shown, pandoc.Span('(' .. number .. ')', { class = 'number' }) } or { shown }
end
function Math(math) return math.mathtype == 'DisplayMath' and numbered(math.text) or nil end
function CodeBlock(block)
    if block.classes:includes('mermaid') then -- GitHub draws it; here graphviz does
        local graph = block.text:gsub('^flowchart TD', ''):gsub('[%w_]+%[(.-)%]', '"%1"'):gsub('%-%->', '->')
        local drawn = pandoc.pipe('dot', { '-Tsvg' }, 'digraph { size = "7,9"; node [shape = box, fontname = "sans"];' .. graph .. '}')
        return pandoc.RawBlock('html', drawn:match('<svg.*</svg>'))
    end
    if block.classes:includes('fortran') then block.classes = { 'fortranfree' } return block end -- else a line `call ...` is a comment
    if not block.classes:includes('math') then return nil end
    return pandoc.Div(pandoc.Para(numbered(block.text)), { class = 'equation' })
end
