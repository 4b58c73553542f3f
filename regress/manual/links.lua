-- Links of the manual's pages as they must be in the site (mode 'site': .md becomes .html) and in the book (mode 'book':
-- all pages are one, so that identifiers begin with their page). PAGE is the page's path from the top of the tree.
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
    if not (target == 'README.md' or target:match('^doc/.*%.md$')) then return link.content end
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
    if not block.classes:includes('math') then return nil end
    return pandoc.Div(pandoc.Para(numbered(block.text)), { class = 'equation' })
end
